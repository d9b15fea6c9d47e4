#include "mechanics/coarse_space.hpp"

#include "mechanics/blas.hpp"
#include "mechanics/kernels/kernels.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// With more aggregates than this, a three-level cycle is cheaper than a dense inverse, whose cost grows as their
/// square.
constexpr std::size_t kMaxDenseAggregates = 192;
constexpr std::size_t kAggregatesPerGroup = 8;
constexpr std::size_t kMaxGroups = 512;
/// Eigenvalue, relative to the largest, below which an aggregate cannot make a motion (axes held, or vertices on a
/// line).
constexpr double kLeastMotionShare = 1e-8;

using Mat6 = Eigen::Matrix<double, 6, 6>;
using DenseBlock = Eigen::Map<Mat6, 0, Eigen::OuterStride<>>;

/// Returns the block (i, j), 6 x 6, of an n x n matrix that is stored by columns.
DenseBlock block_at(std::vector<double>& dense, std::size_t n, std::size_t i, std::size_t j) {
  return DenseBlock(dense.data() + 6 * n * j + 6 * i, Eigen::OuterStride<>(static_cast<Eigen::Index>(n)));
}

/// Returns, as columns, the independent combinations of six motions, of unit size, from the Gram matrix of the motions.
/// Columns that correspond to no motion are zero.
Mat6 independent_motions(const Mat6& gram) {
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

/// Returns the blocks in the layout of a CoarseCycle.
std::vector<double> packed(const std::vector<Mat6>& blocks, bool is_transposed) {
  std::vector<double> numbers(kCoarseBlock * blocks.size(), 0.0);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (int column = 0; column < 6; ++column) {
      for (int row = 0; row < 6; ++row) {
        numbers[kCoarseBlock * b + static_cast<std::size_t>(8 * column + row)] =
            is_transposed ? blocks[b](column, row) : blocks[b](row, column);
      }
    }
  }
  return numbers;
}

/// Copies the lower triangle of an n x n matrix, stored by columns, to the upper one.
void mirror(std::vector<double>& dense, std::size_t n) {
  for (std::size_t column = 0; column < n; ++column) {
    for (std::size_t row = column + 1; row < n; ++row) dense[row * n + column] = dense[column * n + row];
  }
}

/// Inverts a positive definite matrix in place, given its lower triangle.
void invert(std::vector<double>& dense, std::size_t size) {
  const int n = static_cast<int>(size);
  int info = 0;
  hold_blas_to_one_thread();
  dpotrf_("L", &n, dense.data(), &n, &info);
  INCISE_REQUIRE(info == 0,
                 fmt::format("expected a positive definite matrix, found that coarse pivot {} is not above 0", info));
  dpotri_("L", &n, dense.data(), &n, &info);
  INCISE_REQUIRE(info == 0, fmt::format("expected a regular coarse matrix, found a zero at {}", info));
  mirror(dense, size);
}

}  // namespace

CoarseSpace::CoarseSpace(std::span<const Vec3> positions, std::size_t per_aggregate)
    : aggregates_(bisect(positions, per_aggregate)),
      center_(aggregates_.count()),
      radius_(aggregates_.count()),
      arm_(positions.size()),
      free_(positions.size(), Vec3::Ones()) {
  for (std::size_t a = 0; a < aggregates_.count(); ++a) {
    const auto members = aggregates_.members(a);
    Vec3 center = Vec3::Zero();
    for (const std::int32_t v : members) center += positions[static_cast<std::size_t>(v)];
    center /= static_cast<double>(members.size());
    double squared = 0.0;
    for (const std::int32_t v : members) squared += (positions[static_cast<std::size_t>(v)] - center).squaredNorm();
    const double radius = std::sqrt(squared / static_cast<double>(members.size()));
    for (const std::int32_t v : members) {
      const Vec3 offset = positions[static_cast<std::size_t>(v)] - center;
      arm_[static_cast<std::size_t>(v)] = radius > 0.0 ? Vec3(offset / radius) : Vec3::Zero();
    }
    center_[a] = center;
    radius_[a] = radius;
  }
  if (aggregates_.count() <= kMaxDenseAggregates) return;
  groups_ = bisect(center_, std::max(kAggregatesPerGroup, (center_.size() + kMaxGroups - 1) / kMaxGroups));
  cycle_.group = groups_.of_vertex;
  cycle_.groups = groups_.count();
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

/// Adds the six columns of Pᵀ A P that belong to one aggregate to target(other aggregate), blocks of 6 x 6.
template <class Target>
void CoarseSpace::project_rows(const BlockMatrix& matrix, std::size_t aggregate, const Target& target) const {
  std::vector<std::pair<std::int32_t, Modes>> sums;  // of A_vw P_w over the vertices w of each neighbouring aggregate
  for (const std::int32_t member : aggregates_.members(aggregate)) {
    const auto v = static_cast<std::size_t>(member);
    sums.clear();
    for (auto slot = matrix.pattern->row_start[v]; slot < matrix.pattern->row_start[v + 1]; ++slot) {
      const auto w = static_cast<std::size_t>(matrix.pattern->column[static_cast<std::size_t>(slot)]);
      const std::int32_t other = aggregates_.of_vertex[w];
      auto sum = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == other; });
      if (sum == sums.end()) sum = sums.insert(sums.end(), {other, Modes::Zero()});
      sum->second.noalias() += matrix.at(slot) * modes(w);
    }
    const Modes own = modes(v);
    for (const auto& [other, sum] : sums) target(other).noalias() += sum.transpose() * own;
  }
}

CoarseSpace::Mat6 CoarseSpace::motions_of(std::size_t aggregate) const {
  Mat6 gram = Mat6::Zero();
  for (const std::int32_t v : aggregates_.members(aggregate)) {
    const Modes p = modes(static_cast<std::size_t>(v));
    gram.noalias() += p.transpose() * p;
  }
  return independent_motions(gram);
}

/// Each 6 x 6 block B_ij becomes Tᵀ_i B_ij T_j, for the blocks on and below the diagonal.
void CoarseSpace::change_basis(const std::vector<Mat6>& basis, Workers& workers) {
  workers.for_each(aggregates_.count(), 8, [&](std::size_t j) {
    for (std::size_t i = j; i < aggregates_.count(); ++i) {
      DenseBlock b = block_at(dense_, size(), i, j);
      if (b.isZero(0.0)) continue;
      b = (basis[i].transpose() * b * basis[j]).eval();
    }
  });
}

void CoarseSpace::refresh_dense(const BlockMatrix& matrix, Workers& workers) {
  const std::size_t n = size();
  dense_.resize(n * n);
  workers.for_each(aggregates_.count(), 4, [&](std::size_t a) {
    std::fill_n(dense_.begin() + static_cast<std::ptrdiff_t>(6 * n * a), 6 * n, 0.0);
    project_rows(matrix, a,
                 [&](std::int32_t other) { return block_at(dense_, n, static_cast<std::size_t>(other), a); });
  });

  std::vector<Mat6> basis(aggregates_.count());
  for (std::size_t a = 0; a < basis.size(); ++a) basis[a] = motions_of(a);
  change_basis(basis, workers);
  for (std::size_t a = 0; a < basis.size(); ++a) {
    for (std::size_t i = 0; i < 6; ++i) {
      // A motion that cannot be made has a row of zeros; a 1 keeps the matrix invertible, and T removes it again.
      if (basis[a].col(static_cast<int>(i)).isZero(0.0)) dense_[(6 * a + i) * (n + 1)] = 1.0;
    }
  }
  invert(dense_, n);
  for (Mat6& b : basis) b.transposeInPlace();
  change_basis(basis, workers);
  mirror(dense_, n);
}

/// Finds which aggregates are coupled by an entry of A.
void CoarseSpace::connect_aggregates(const BlockPattern& pattern) {
  cycle_.row_start.push_back(0);
  std::vector<std::int32_t> others;
  for (std::size_t a = 0; a < aggregates_.count(); ++a) {
    others.clear();
    for (const std::int32_t v : aggregates_.members(a)) {
      for (const std::int32_t w : pattern.columns_of(static_cast<std::size_t>(v)))
        others.push_back(aggregates_.of_vertex[static_cast<std::size_t>(w)]);
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    cycle_.column.insert(cycle_.column.end(), others.begin(), others.end());
    cycle_.row_start.push_back(static_cast<std::int32_t>(cycle_.column.size()));
  }
  blocks_.resize(cycle_.column.size());
  for (std::vector<Mat6>* blocks : {&basis_, &into_basis_, &lift_}) blocks->resize(aggregates_.count());
}

/// Computes the blocks of one aggregate's row, each still transposed.
void CoarseSpace::project_blocks(const BlockMatrix& matrix, std::size_t aggregate) {
  std::fill(blocks_.begin() + cycle_.row_start[aggregate], blocks_.begin() + cycle_.row_start[aggregate + 1],
            Mat6(Mat6::Zero()));
  project_rows(matrix, aggregate, [&](std::int32_t other) -> Mat6& {
    return blocks_[cycle_.slot_from(aggregate, static_cast<std::size_t>(other))];
  });
}

/// Finds a basis of the motions that an aggregate can make, in which its diagonal block is 1.
void CoarseSpace::find_basis(std::size_t aggregate) {
  const Mat6 motions = motions_of(aggregate);
  Mat6 diagonal = motions.transpose() * blocks_[cycle_.slot_from(aggregate, aggregate)] * motions;
  Mat6 into_motions = Mat6::Zero();  // left inverse of `motions`, whose columns are orthogonal
  for (int i = 0; i < 6; ++i) {
    if (motions.col(i).isZero(0.0)) {
      diagonal(i, i) = 1.0;  // as in refresh_dense
    } else {
      into_motions.row(i) = motions.col(i).transpose() / motions.col(i).squaredNorm();
    }
  }
  const Eigen::LLT<Mat6> factor(diagonal);
  INCISE_REQUIRE(
      factor.info() == Eigen::Success,
      fmt::format("expected a positive definite matrix, found one that is not positive definite on aggregate {}",
                  aggregate));
  basis_[aggregate] = factor.matrixL().solve(motions.transpose()).transpose();
  into_basis_[aggregate] = factor.matrixU() * into_motions;
}

/// Replaces B_ij by Tᵀ_i B_ij T_j in one aggregate's row.
void CoarseSpace::change_block_basis(std::size_t aggregate) {
  for (auto slot = cycle_.row_start[aggregate]; slot < cycle_.row_start[aggregate + 1]; ++slot) {
    const auto other = static_cast<std::size_t>(cycle_.column[static_cast<std::size_t>(slot)]);
    Mat6& block = blocks_[static_cast<std::size_t>(slot)];
    block = other == aggregate ? Mat6(Mat6::Identity())
                               : Mat6(basis_[aggregate].transpose() * block.transpose() * basis_[other]);
  }
}

/// Returns, in the aggregate's basis, its motion for each of the six motions of its group: t + ω × (its centre minus
/// the group's) and ω, both scaled by the radii.
CoarseSpace::Mat6 CoarseSpace::rigid_lift(std::size_t aggregate) const {
  const auto group = static_cast<std::size_t>(groups_.of_vertex[aggregate]);
  Vec3 middle = Vec3::Zero();
  const auto members = groups_.start[group + 1] - groups_.start[group];
  for (const std::int32_t member : groups_.members(group))
    middle += center_[static_cast<std::size_t>(member)] / members;
  double squared = 0.0;
  for (const std::int32_t member : groups_.members(group)) {
    const auto a = static_cast<std::size_t>(member);
    squared += ((center_[a] - middle).squaredNorm() + radius_[a] * radius_[a]) / members;
  }
  const double radius = squared > 0.0 ? std::sqrt(squared) : 1.0;
  const Vec3 arm = (center_[aggregate] - middle) / radius;
  Mat6 lift = Mat6::Identity();
  lift.topRightCorner<3, 3>() << 0.0, arm[2], -arm[1], -arm[2], 0.0, arm[0], arm[1], -arm[0], 0.0;
  lift.bottomRightCorner<3, 3>() *= radius_[aggregate] / radius;
  return into_basis_[aggregate] * lift;
}

/// Finds the lift of every aggregate from the independent motions of its group.
void CoarseSpace::find_lifts() {
  for (std::size_t a = 0; a < aggregates_.count(); ++a) lift_[a] = rigid_lift(a);
  for (std::size_t group = 0; group < groups_.count(); ++group) {
    Mat6 gram = Mat6::Zero();
    for (const std::int32_t a : groups_.members(group)) {
      gram.noalias() += lift_[static_cast<std::size_t>(a)].transpose() * lift_[static_cast<std::size_t>(a)];
    }
    const Mat6 basis = independent_motions(gram);
    for (const std::int32_t a : groups_.members(group)) {
      lift_[static_cast<std::size_t>(a)] = (lift_[static_cast<std::size_t>(a)] * basis).eval();
    }
  }
}

/// Computes the dense inverse of the third level.
void CoarseSpace::project_groups() {
  const std::size_t n = 6 * groups_.count();
  cycle_.top.assign(n * n, 0.0);
  for (std::size_t a = 0; a < aggregates_.count(); ++a) {
    const auto row = static_cast<std::size_t>(cycle_.group[a]);
    for (auto slot = cycle_.row_start[a]; slot < cycle_.row_start[a + 1]; ++slot) {
      const auto b = static_cast<std::size_t>(cycle_.column[static_cast<std::size_t>(slot)]);
      const auto column = static_cast<std::size_t>(cycle_.group[b]);
      if (column > row) continue;
      block_at(cycle_.top, n, row, column) += lift_[a].transpose() * blocks_[static_cast<std::size_t>(slot)] * lift_[b];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    // A motion that no member can make has a row of zeros, as in refresh_dense; no lift uses it.
    if (cycle_.top[i * (n + 1)] == 0.0) cycle_.top[i * (n + 1)] = 1.0;
  }
  invert(cycle_.top, n);
}

void CoarseSpace::refresh_cycle(const BlockMatrix& matrix, Workers& workers) {
  if (cycle_.row_start.empty()) connect_aggregates(*matrix.pattern);
  workers.for_each(aggregates_.count(), 4, [&](std::size_t a) {
    project_blocks(matrix, a);
    find_basis(a);
  });
  workers.for_each(aggregates_.count(), 4, [&](std::size_t a) { change_block_basis(a); });
  find_lifts();
  project_groups();
  for (std::size_t a = 0; a < aggregates_.count(); ++a)
    blocks_[cycle_.slot_from(a, a)].setZero();  // the 1 is implied in Gauss-Seidel
  cycle_.blocks = packed(blocks_, false);
  cycle_.basis = packed(basis_, false);
  cycle_.basis_transposed = packed(basis_, true);
  cycle_.lift = packed(lift_, false);
  cycle_.lift_transposed = packed(lift_, true);
}

void CoarseSpace::refresh(const BlockMatrix& matrix, Workers& workers) {
  if (is_dense()) {
    refresh_dense(matrix, workers);
  } else {
    refresh_cycle(matrix, workers);
  }
}

void CoarseSpace::apply(std::span<const double> c, std::span<double> y, Workers& workers) {
  if (!is_dense()) {
    cycle_.apply(c, y, workers);
    return;
  }
  const std::size_t n = size();
  workers.for_chunks(n, kCoarseRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    kernels().multiply_dense(dense_.data(), n, c.data(), y.data(), begin, end);
  });
}

}  // namespace incise
