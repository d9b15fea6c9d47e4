#include "mechanics/coarse_space.hpp"

#include "mechanics/blas.hpp"
#include "mechanics/kernels/kernels.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// A dense inverse of more than 6 x 512 unknowns would cost more than the iterations it saves.
constexpr std::size_t kMaxAggregates = 512;
/// Share of an aggregate's largest motion below which another counts as one it cannot make (held, or all vertices on a
/// line).
constexpr double kLeastMotionShare = 1e-8;
constexpr std::size_t kCoarseRowsPerChunk = 192;

std::size_t group_size(std::size_t vertices, std::size_t wanted) {
  return std::max(wanted, (vertices + kMaxAggregates - 1) / kMaxAggregates);
}

}  // namespace

CoarseSpace::CoarseSpace(std::span<const Vec3> positions, std::size_t per_aggregate)
    : aggregates_(bisect(positions, group_size(positions.size(), per_aggregate))),
      arm_(positions.size()),
      free_(positions.size(), Vec3::Ones()) {
  for (std::size_t a = 0; a < aggregates_.count(); ++a) {
    const auto begin = aggregates_.vertices.begin() + aggregates_.start[a];
    const auto end = aggregates_.vertices.begin() + aggregates_.start[a + 1];
    Vec3 center = Vec3::Zero();
    for (auto v = begin; v != end; ++v) center += positions[static_cast<std::size_t>(*v)];
    center /= static_cast<double>(end - begin);
    double squared = 0.0;
    for (auto v = begin; v != end; ++v) squared += (positions[static_cast<std::size_t>(*v)] - center).squaredNorm();
    const double radius = std::sqrt(squared / static_cast<double>(end - begin));
    for (auto v = begin; v != end; ++v) {
      const Vec3 offset = positions[static_cast<std::size_t>(*v)] - center;
      arm_[static_cast<std::size_t>(*v)] = radius > 0.0 ? Vec3(offset / radius) : Vec3::Zero();
    }
  }
}

void CoarseSpace::set_held(std::span<const std::uint8_t> held) {
  for (std::size_t v = 0; v < held.size(); ++v) {
    for (int i = 0; i < 3; ++i) free_[v][i] = (held[v] >> i & 1U) != 0 ? 0.0 : 1.0;
  }
}

CoarseSpace::Modes CoarseSpace::modes(std::size_t v) const {
  const Vec3& r = arm_[v];
  Modes p;
  p << 1.0, 0.0, 0.0, 0.0, r[2], -r[1],  //
      0.0, 1.0, 0.0, -r[2], 0.0, r[0],   //
      0.0, 0.0, 1.0, r[1], -r[0], 0.0;
  return free_[v].asDiagonal() * p;
}

/// The six rows of Pᵀ A P that belong to one aggregate. dense_ is column-major, so they are written as columns: A is
/// symmetric.
void CoarseSpace::project_rows(const BlockMatrix& matrix, std::size_t aggregate) {
  using RowBlock = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  const std::size_t n = size();
  std::fill_n(dense_.begin() + static_cast<std::ptrdiff_t>(6 * n * aggregate), 6 * n, 0.0);
  std::vector<std::pair<std::int32_t, Modes>> sums;  // of A_vw P_w over the vertices w of each neighbouring aggregate
  for (auto i = aggregates_.start[aggregate]; i < aggregates_.start[aggregate + 1]; ++i) {
    const auto v = static_cast<std::size_t>(aggregates_.vertices[static_cast<std::size_t>(i)]);
    sums.clear();
    for (auto slot = matrix.pattern->row_start[v]; slot < matrix.pattern->row_start[v + 1]; ++slot) {
      const auto w = static_cast<std::size_t>(matrix.pattern->column[static_cast<std::size_t>(slot)]);
      const std::int32_t other = aggregates_.of_vertex[w];
      auto sum = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == other; });
      if (sum == sums.end()) sum = sums.insert(sums.end(), {other, Modes::Zero()});
      sum->second.noalias() += RowBlock(matrix.block(slot)) * modes(w);
    }
    const Modes own = modes(v);
    for (const auto& [other, sum] : sums) {
      Eigen::Map<Mat6, 0, Eigen::OuterStride<>> target(
          dense_.data() + 6 * n * aggregate + 6 * static_cast<std::size_t>(other),
          Eigen::OuterStride<>(static_cast<Eigen::Index>(n)));
      target.noalias() += sum.transpose() * own;
    }
  }
}

/// Columns: combinations of the six motions that the aggregate's free axes can make, of unit size; zero columns for the
/// rest.
CoarseSpace::Mat6 CoarseSpace::independent_motions(std::size_t aggregate) const {
  Mat6 gram = Mat6::Zero();
  for (auto i = aggregates_.start[aggregate]; i < aggregates_.start[aggregate + 1]; ++i) {
    const Modes p = modes(static_cast<std::size_t>(aggregates_.vertices[static_cast<std::size_t>(i)]));
    gram.noalias() += p.transpose() * p;
  }
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(gram);
  Mat6 basis = Mat6::Zero();
  for (int i = 0; i < 6; ++i) {
    const double size = solver.eigenvalues()[i];
    if (size > 0.0 && size > kLeastMotionShare * solver.eigenvalues()[5]) {
      basis.col(i) = solver.eigenvectors().col(i) / std::sqrt(size);
    }
  }
  return basis;
}

/// Each 6 x 6 block B_ij becomes Tᵀ_i B_ij T_j, for the blocks on and below the diagonal.
void CoarseSpace::change_basis(const std::vector<Mat6>& basis, Workers& workers) {
  const std::size_t n = size();
  using Block = Eigen::Map<Mat6, 0, Eigen::OuterStride<>>;
  const auto block = [&](std::size_t i, std::size_t j) {
    return Block(dense_.data() + 6 * n * j + 6 * i, Eigen::OuterStride<>(static_cast<Eigen::Index>(n)));
  };
  workers.for_each(aggregates_.count(), 8, [&](std::size_t j) {
    for (std::size_t i = j; i < aggregates_.count(); ++i) {
      Block b = block(i, j);
      if (b.isZero(0.0)) continue;
      b = (basis[i].transpose() * b * basis[j]).eval();
    }
  });
}

void CoarseSpace::invert() {
  const int n = static_cast<int>(size());
  int info = 0;
  hold_blas_to_one_thread();
  dpotrf_("L", &n, dense_.data(), &n, &info);
  INCISE_REQUIRE(info == 0,
                 fmt::format("expected a positive definite matrix, found coarse pivot {} not above 0", info));
  dpotri_("L", &n, dense_.data(), &n, &info);
  INCISE_REQUIRE(info == 0, fmt::format("expected a regular coarse matrix, found a zero at {}", info));
  mirror();
}

/// Copies the lower triangle to the upper one.
void CoarseSpace::mirror() {
  const std::size_t n = size();
  for (std::size_t column = 0; column < n; ++column) {
    for (std::size_t row = column + 1; row < n; ++row) dense_[row * n + column] = dense_[column * n + row];
  }
}

void CoarseSpace::refresh(const BlockMatrix& matrix, Workers& workers) {
  const std::size_t n = size();
  dense_.resize(n * n);
  workers.for_each(aggregates_.count(), 4, [&](std::size_t a) { project_rows(matrix, a); });

  std::vector<Mat6> basis(aggregates_.count());
  for (std::size_t a = 0; a < basis.size(); ++a) basis[a] = independent_motions(a);
  change_basis(basis, workers);
  for (std::size_t a = 0; a < basis.size(); ++a) {
    for (std::size_t i = 0; i < 6; ++i) {
      // A motion that cannot be made has an empty row; a 1 keeps the factorisation going and T removes it again.
      if (basis[a].col(static_cast<int>(i)).isZero(0.0)) dense_[(6 * a + i) * (n + 1)] = 1.0;
    }
  }
  invert();
  for (Mat6& b : basis) b.transposeInPlace();
  change_basis(basis, workers);
  mirror();
}

void CoarseSpace::apply(std::span<const double> c, std::span<double> y, Workers& workers) const {
  const std::size_t n = size();
  workers.for_chunks(n, kCoarseRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    kernels().multiply_dense(dense_.data(), n, c.data(), y.data(), begin, end);
  });
}

}  // namespace incise
