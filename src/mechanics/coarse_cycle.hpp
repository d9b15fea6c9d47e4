#pragma once

#include <incise/core/workers.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Numbers that a 6 x 6 block of a CoarseCycle takes: six columns of eight, of which the last two are 0.
inline constexpr std::size_t kCoarseBlock = 48;

/// Solves the coarse system nearly, where it is too large for a dense inverse: a symmetric V-cycle with a third level,
/// the rigid motions of groups of aggregates. Forward Gauss and Seidel by blocks from zero, the dense inverse of the
/// third level for what is left, backward Gauss and Seidel: symmetric positive definite, as a preconditioner has to be.
/// Gauss and Seidel go in the order of the aggregates on one thread: the same bits at any thread count.
template <class Real>
struct CoarseCycle {
  std::vector<std::int32_t> row_start;  ///< aggregates + 1
  std::vector<std::int32_t> column;     ///< ascending within a row, the diagonal included
  /// Of the coarse matrix in bases in which its diagonal blocks are 1; in their places stand zeros.
  std::vector<Real> blocks;
  std::vector<Real> basis,
      basis_transposed;  ///< per aggregate a block: motions that it can make; zero columns for the rest
  std::vector<Real> lift,
      lift_transposed;              ///< per aggregate a block: its motion, in its basis, for each motion of its group
  std::vector<std::int32_t> group;  ///< per aggregate
  std::size_t groups = 0;
  std::vector<Real> top;  ///< dense inverse of the third level: 6 groups x 6 groups, symmetric

  [[nodiscard]] std::size_t aggregates() const { return row_start.size() - 1; }
  /// y = C c. Six numbers per aggregate.
  void apply(std::span<const Real> c, std::span<Real> y, Workers& workers);

 private:
  void sweep_forward(std::span<const Real> c);
  void add_motions_of_groups(Workers& workers);
  void sweep_backward(std::span<Real> y);

  std::vector<Real> right_, motion_;              // eight per aggregate, the last two 0
  std::vector<Real> group_force_, group_motion_;  // six per group
};

/// The same cycle with its numbers rounded.
[[nodiscard]] CoarseCycle<float> rounded(const CoarseCycle<double>& cycle);

extern template struct CoarseCycle<double>;
extern template struct CoarseCycle<float>;

}  // namespace incise
