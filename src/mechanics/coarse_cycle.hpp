#pragma once

#include <incise/core/workers.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Stored numbers per 6 x 6 block of a CoarseCycle: six columns of eight numbers, the last two of each 0.
inline constexpr std::size_t kCoarseBlock = 48;

/// Approximate solver for a coarse system that is too large for a dense inverse: a symmetric V-cycle with a third
/// level, the rigid motions of groups of aggregates. Forward block Gauss-Seidel from zero, the dense inverse of the
/// third level applied to the residual, backward block Gauss-Seidel: symmetric positive definite, as a preconditioner
/// must be. Gauss-Seidel visits the aggregates in order on one thread: same bits at any thread count.
template <class Real>
struct CoarseCycle {
  std::vector<std::int32_t> row_start;  ///< aggregates + 1
  std::vector<std::int32_t> column;     ///< ascending within a row, the diagonal included
  /// Blocks of the coarse matrix, in bases in which the diagonal blocks are 1; those are stored as zeros.
  std::vector<Real> blocks;
  std::vector<Real> basis,
      basis_transposed;  ///< one block per aggregate: a basis of the motions that it can make, else zero columns
  std::vector<Real> lift,
      lift_transposed;  ///< one block per aggregate: its motion, in its basis, for each motion of its group
  std::vector<std::int32_t> group;  ///< per aggregate
  std::size_t groups = 0;
  std::vector<Real> top;  ///< dense inverse of the third level: 6 groups x 6 groups, symmetric

  [[nodiscard]] std::size_t aggregates() const { return row_start.size() - 1; }
  /// Returns the first slot in a row at or after the block of an aggregate.
  [[nodiscard]] std::size_t slot_from(std::size_t row, std::size_t aggregate) const {
    const auto begin = column.begin() + row_start[row];
    const auto end = column.begin() + row_start[row + 1];
    return static_cast<std::size_t>(std::lower_bound(begin, end, static_cast<std::int32_t>(aggregate)) -
                                    column.begin());
  }
  /// Computes y = C c; six numbers per aggregate.
  void apply(std::span<const Real> c, std::span<Real> y, Workers& workers);

 private:
  void sweep_forward(std::span<const Real> c);
  void add_motions_of_groups(Workers& workers);
  void sweep_backward(std::span<Real> y);

  std::vector<Real> right_, motion_;              // eight per aggregate, the last two 0
  std::vector<Real> group_force_, group_motion_;  // six per group
};

/// Returns the cycle rounded to single precision.
[[nodiscard]] CoarseCycle<float> rounded(const CoarseCycle<double>& cycle);

extern template struct CoarseCycle<double>;
extern template struct CoarseCycle<float>;

}  // namespace incise
