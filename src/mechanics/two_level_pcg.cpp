#include "mechanics/block_product.hpp"
#include "mechanics/coarse_space.hpp"
#include "mechanics/pcg_iteration.hpp"
#include "mechanics/single_pcg.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/solvers.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

/// Returns the axes of a diagonal block that hold_constrained turned into identity rows, bit i for axis i.
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

  std::unique_ptr<SinglePcg> single;  // iterates in single precision; null with Precision::Double

  // Vectors of one solve (in single precision empty until a system must be solved again), and a partial sum per chunk.
  Points r, z, p, q;
  std::vector<double> restricted, corrected;
  std::vector<double> partial_rr, partial_rz, partial_pq;

  Data(std::shared_ptr<const BlockPattern> given, std::span<const Vec3> positions, std::size_t per_aggregate,
       Precision precision)
      : pattern(std::move(given)),
        coarse(positions, per_aggregate),
        inverse_diagonal(pattern->rows()),
        held(pattern->rows()),
        single(precision == Precision::Single ? std::make_unique<SinglePcg>(pattern, coarse) : nullptr),
        r(single ? 0 : pattern->rows()),
        z(r.size()),
        p(r.size()),
        q(r.size()),
        restricted(coarse.size()),
        corrected(coarse.size()),
        partial_rr(Workers::chunk_count(coarse.aggregates().count(), kAggregatesPerChunk)),
        partial_rz(partial_rr.size()),
        partial_pq(Workers::chunk_count(pattern->rows(), kRowsPerChunk)) {}

  template <class Body>
  void for_aggregates(Workers& workers, const Body& body) const {
    workers.for_chunks(coarse.aggregates().count(), kAggregatesPerChunk, body);
  }

  /// x += alpha p, r -= alpha q, z = D⁻¹ r and the restriction Pᵀ r, in one sweep; fills partial_rr and partial_rz
  /// (without the coarse part).
  void move_and_precondition(double alpha, std::span<Vec3> x, Workers& workers) {
    for_aggregates(workers, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      double rr = 0.0;
      double rz = 0.0;
      for (std::size_t a = begin; a < end; ++a) {
        Vec6 sum = Vec6::Zero();
        for (const std::int32_t member : coarse.aggregates().members(a)) {
          const auto v = static_cast<std::size_t>(member);
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
        for (const std::int32_t member : coarse.aggregates().members(a)) {
          const auto v = static_cast<std::size_t>(member);
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

  /// y = C Pᵀ r; returns r · M⁻¹ r, since r · P y = (Pᵀ r) · y.
  double finish_preconditioning(Workers& workers) {
    coarse.apply(restricted, corrected, workers);
    return sum_of(partial_rz) + std::inner_product(restricted.begin(), restricted.end(), corrected.begin(), 0.0);
  }
};

TwoLevelPcg::TwoLevelPcg(std::shared_ptr<const BlockPattern> pattern, std::span<const Vec3> positions,
                         int vertices_per_aggregate, Precision precision) {
  INCISE_REQUIRE(pattern != nullptr && positions.size() == pattern->rows(),
                 fmt::format("expected one position per row, found {}", positions.size()));
  INCISE_REQUIRE(vertices_per_aggregate > 0,
                 fmt::format("expected at least 1 vertex per aggregate, found {}", vertices_per_aggregate));
  INCISE_REQUIRE(std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); }),
                 "expected finite positions");
  data_ = std::make_unique<Data>(std::move(pattern), positions, static_cast<std::size_t>(vertices_per_aggregate),
                                 precision);
}
TwoLevelPcg::~TwoLevelPcg() = default;
TwoLevelPcg::TwoLevelPcg(TwoLevelPcg&&) noexcept = default;
TwoLevelPcg& TwoLevelPcg::operator=(TwoLevelPcg&&) noexcept = default;

void TwoLevelPcg::update(const BlockMatrix& matrix, bool refresh_coarse, Workers& workers,
                         std::span<const std::uint8_t> changed_rows) {
  Data& d = *data_;
  INCISE_REQUIRE(matrix.pattern == d.pattern, "expected a matrix of the pattern that the solver was made for");
  if (!d.has_coarse) changed_rows = {};  // first update
  INCISE_REQUIRE(changed_rows.empty() || changed_rows.size() == d.pattern->rows(),
                 fmt::format("expected one flag per row, found {}", changed_rows.size()));
  workers.for_each(d.pattern->rows(), kRowsPerChunk, [&](std::size_t v) {
    if (!changed_rows.empty() && changed_rows[v] == 0) return;
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
  const bool has_new_coarse = refresh_coarse || !d.has_coarse;
  if (has_new_coarse) {
    d.coarse.refresh(matrix, workers);
    d.has_coarse = true;
  }
  if (d.single) d.single->update(matrix, d.inverse_diagonal, d.coarse, has_new_coarse, changed_rows, workers);
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
  INCISE_REQUIRE(
      b.size() == d.pattern->rows() && x.size() == d.pattern->rows(),
      fmt::format("expected vectors of {} vertices, found {} and {}", d.pattern->rows(), b.size(), x.size()));
  PcgReport in_single;
  if (d.single) {
    in_single = d.single->solve(b, x, settings, workers);
    if (in_single.converged) return in_single;
    for (Points* vector : {&d.r, &d.z, &d.p, &d.q}) vector->resize(d.pattern->rows());
  }
  std::copy(b.begin(), b.end(), d.r.begin());
  std::fill(x.begin(), x.end(), Vec3::Zero());
  std::fill(d.p.begin(), d.p.end(), Vec3::Zero());
  std::fill(d.q.begin(), d.q.end(), Vec3::Zero());
  struct Sweeps {
    Data& data;
    const BlockMatrix& matrix;
    std::span<Vec3> x;
    Workers& workers;
    double move(double alpha) {
      data.move_and_precondition(alpha, x, workers);
      return std::sqrt(sum_of(data.partial_rr));
    }
    double precondition() { return data.finish_preconditioning(workers); }
    void turn(double beta) { data.turn_direction(beta, workers); }
    double multiply() { return data.apply_matrix(matrix, workers); }
  } sweeps{d, matrix, x, workers};
  PcgReport report = iterate(sweeps, settings);
  report.iterations += in_single.iterations;
  return report;
}

}  // namespace incise
