#include "mechanics/block_product.hpp"
#include "mechanics/coarse_space.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/solvers.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

constexpr std::size_t kAggregatesPerChunk = 4;

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Bits of the axes of a diagonal block that hold_constrained turned into identity rows.
std::uint8_t identity_axes(const double* block) {
  std::uint8_t axes = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double* row = block + 3 * i;
    if (row[i] == 1.0 && row[(i + 1) % 3] == 0.0 && row[(i + 2) % 3] == 0.0) {
      axes = static_cast<std::uint8_t>(axes | (1U << i));
    }
  }
  return axes;
}

}  // namespace

struct TwoLevelPcg::Data {
  std::shared_ptr<const BlockPattern> pattern;
  CoarseSpace coarse;
  bool has_coarse = false;
  std::vector<Mat3> inverse_diagonal;
  std::vector<std::uint8_t> held;

  // Vectors of one solve, and one partial sum per chunk.
  Points r, z, p, q;
  std::vector<double> restricted, corrected;
  std::vector<double> partial_rr, partial_rz, partial_pq;

  Data(std::shared_ptr<const BlockPattern> given, std::span<const Vec3> positions, std::size_t per_aggregate)
      : pattern(std::move(given)),
        coarse(positions, per_aggregate),
        inverse_diagonal(pattern->rows()),
        held(pattern->rows()),
        r(pattern->rows()),
        z(pattern->rows()),
        p(pattern->rows()),
        q(pattern->rows()),
        restricted(coarse.size()),
        corrected(coarse.size()),
        partial_rr(Workers::chunk_count(coarse.aggregates().count(), kAggregatesPerChunk)),
        partial_rz(partial_rr.size()),
        partial_pq(Workers::chunk_count(pattern->rows(), kRowsPerChunk)) {}

  template <class Body>
  void for_aggregates(Workers& workers, const Body& body) const {
    workers.for_chunks(coarse.aggregates().count(), kAggregatesPerChunk, body);
  }

  /// x += alpha p, r -= alpha q, z = D⁻¹ r and the restriction of r, in one sweep; fills partial_rr and partial_rz
  /// (without coarse part).
  void move_and_precondition(double alpha, std::span<Vec3> x, Workers& workers) {
    for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      double rr = 0.0;
      double rz = 0.0;
      for (std::size_t a = begin; a < end; ++a) {
        Vec6 sum = Vec6::Zero();
        for (auto i = coarse.aggregates().start[a]; i < coarse.aggregates().start[a + 1]; ++i) {
          const auto v = static_cast<std::size_t>(coarse.aggregates().vertices[static_cast<std::size_t>(i)]);
          x[v] += alpha * p[v];
          r[v] -= alpha * q[v];
          z[v].noalias() = inverse_diagonal[v] * r[v];
          rr += r[v].squaredNorm();
          rz += r[v].dot(z[v]);
          coarse.add_restricted(v, r[v], sum);
        }
        std::copy_n(sum.data(), 6, restricted.begin() + static_cast<std::ptrdiff_t>(6 * a));
      }
      partial_rr[chunk] = rr;
      partial_rz[chunk] = rz;
    });
  }

  /// p = z + P y + beta p.
  void turn_direction(double beta, Workers& workers) {
    for_aggregates(workers, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t a = begin; a < end; ++a) {
        const double* y = corrected.data() + 6 * a;
        for (auto i = coarse.aggregates().start[a]; i < coarse.aggregates().start[a + 1]; ++i) {
          const auto v = static_cast<std::size_t>(coarse.aggregates().vertices[static_cast<std::size_t>(i)]);
          p[v] = z[v] + coarse.prolonged(v, y) + beta * p[v];
        }
      }
    });
  }

  /// q = A p; returns p · q.
  double apply_matrix(const BlockMatrix& matrix, Workers& workers) {
    workers.for_chunks(pattern->rows(), kRowsPerChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      multiply_rows(matrix, p, q, begin, end);
      double pq = 0.0;
      for (std::size_t v = begin; v < end; ++v) pq += p[v].dot(q[v]);
      partial_pq[chunk] = pq;
    });
    return sum_of(partial_pq);
  }

  /// y = C Pᵀ r; returns r · M r, since r · P y = (Pᵀ r) · y.
  double finish_preconditioning(Workers& workers) {
    coarse.apply(restricted, corrected, workers);
    return sum_of(partial_rz) + std::inner_product(restricted.begin(), restricted.end(), corrected.begin(), 0.0);
  }
};

TwoLevelPcg::TwoLevelPcg(std::shared_ptr<const BlockPattern> pattern, std::span<const Vec3> positions,
                         int vertices_per_aggregate) {
  INCISE_REQUIRE(pattern != nullptr && positions.size() == pattern->rows(),
                 fmt::format("expected one position per row, found {}", positions.size()));
  INCISE_REQUIRE(vertices_per_aggregate > 0,
                 fmt::format("expected at least 1 vertex per aggregate, found {}", vertices_per_aggregate));
  INCISE_REQUIRE(std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); }),
                 "expected finite positions");
  data_ = std::make_unique<Data>(std::move(pattern), positions, static_cast<std::size_t>(vertices_per_aggregate));
}
TwoLevelPcg::~TwoLevelPcg() = default;
TwoLevelPcg::TwoLevelPcg(TwoLevelPcg&&) noexcept = default;
TwoLevelPcg& TwoLevelPcg::operator=(TwoLevelPcg&&) noexcept = default;

void TwoLevelPcg::update(const BlockMatrix& matrix, bool refresh_coarse, Workers& workers) {
  Data& d = *data_;
  INCISE_REQUIRE(matrix.pattern == d.pattern, "expected a matrix of the pattern that the solver was made for");
  workers.for_each(d.pattern->rows(), kRowsPerChunk, [&](std::size_t v) {
    const double* block = matrix.block(d.pattern->diagonal[v]);
    const Mat3 diagonal = Eigen::Map<const Mat3>(block);
    const double minor = diagonal(0, 0) * diagonal(1, 1) - diagonal(0, 1) * diagonal(1, 0);
    const double determinant = diagonal.determinant();
    INCISE_REQUIRE(diagonal(0, 0) > 0.0 && minor > 0.0 && determinant > 0.0 && std::isfinite(determinant),
                   fmt::format("expected a positive definite block on the diagonal, found determinant {} at vertex {}",
                               determinant, v));
    d.inverse_diagonal[v] = diagonal.inverse();
    d.held[v] = identity_axes(block);
  });
  d.coarse.set_held(d.held);
  if (refresh_coarse || !d.has_coarse) {
    d.coarse.refresh(matrix, workers);
    d.has_coarse = true;
  }
}

PcgReport TwoLevelPcg::solve(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x,
                             const PcgSettings& settings, Workers& workers) {
  Data& d = *data_;
  INCISE_REQUIRE(d.has_coarse, "expected update() before solve()");
  INCISE_REQUIRE(
      settings.relative_tolerance > 0.0 && std::isfinite(settings.reference_mn) && std::isfinite(settings.floor_mn),
      fmt::format("expected a tolerance above 0 and finite scales, found {}, {} and {}", settings.relative_tolerance,
                  settings.reference_mn, settings.floor_mn));
  INCISE_REQUIRE(matrix.pattern == d.pattern, "expected a matrix of the pattern that the solver was made for");
  INCISE_REQUIRE(b.size() == d.r.size() && x.size() == d.r.size(),
                 fmt::format("expected vectors of {} vertices, found {} and {}", d.r.size(), b.size(), x.size()));
  std::copy(b.begin(), b.end(), d.r.begin());
  std::fill(x.begin(), x.end(), Vec3::Zero());
  std::fill(d.p.begin(), d.p.end(), Vec3::Zero());
  std::fill(d.q.begin(), d.q.end(), Vec3::Zero());
  d.move_and_precondition(0.0, x, workers);

  PcgReport report;
  report.residual_mn = std::sqrt(sum_of(d.partial_rr));
  const double reference = settings.reference_mn > 0.0 ? settings.reference_mn : report.residual_mn;
  const double target = settings.relative_tolerance * std::max(reference, settings.floor_mn);
  double rz_before = 0.0;
  while (!(report.residual_mn <= target) && report.iterations < settings.max_iterations) {
    const double rz = d.finish_preconditioning(workers);
    d.turn_direction(report.iterations == 0 ? 0.0 : rz / rz_before, workers);
    const double pq = d.apply_matrix(matrix, workers);
    if (!(pq > 0.0) || !std::isfinite(rz)) {  // x is the last good iterate
      report.is_indefinite = true;
      return report;
    }
    d.move_and_precondition(rz / pq, x, workers);
    rz_before = rz;
    ++report.iterations;
    report.residual_mn = std::sqrt(sum_of(d.partial_rr));
  }
  report.converged = report.residual_mn <= target;
  return report;
}

}  // namespace incise
