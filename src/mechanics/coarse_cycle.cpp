#include "mechanics/coarse_cycle.hpp"

#include "mechanics/coarse_space.hpp"
#include "mechanics/kernels/kernels.hpp"

#include <algorithm>
#include <array>

namespace incise {
namespace {

template <class Real>
using Eight = std::array<Real, 8>;

// One name for the kernels of both precisions.
void sum_blocks(const double* blocks, const std::int32_t* column, std::size_t count, const double* x, double* sum) {
  kernels().sum_blocks_double(blocks, column, count, x, sum);
}
void sum_blocks(const float* blocks, const std::int32_t* column, std::size_t count, const float* x, float* sum) {
  kernels().sum_blocks_single(blocks, column, count, x, sum);
}
void multiply_top(const double* matrix, std::size_t n, const double* c, double* y, std::size_t begin, std::size_t end) {
  kernels().multiply_dense(matrix, n, c, y, begin, end);
}
void multiply_top(const float* matrix, std::size_t n, const float* c, float* y, std::size_t begin, std::size_t end) {
  kernels().multiply_dense_rows(matrix, n, c, y, begin, end);
}

/// Returns block i times six numbers.
template <class Real>
Eight<Real> times(const std::vector<Real>& blocks, std::size_t i, const Real* x) {
  constexpr std::int32_t kFirst = 0;
  Eight<Real> product;
  sum_blocks(blocks.data() + kCoarseBlock * i, &kFirst, 1, x, product.data());
  return product;
}

}  // namespace

/// Sweeps from zero, in ascending order, and sums the residual over the groups.
template <class Real>
void CoarseCycle<Real>::sweep_forward(std::span<const Real> c) {
  Eight<Real> sum;
  for (std::size_t i = 0; i < aggregates(); ++i) {
    const Eight<Real> force = times(basis_transposed, i, c.data() + 6 * i);
    const auto first = static_cast<std::size_t>(row_start[i]);
    sum_blocks(blocks.data() + kCoarseBlock * first, column.data() + first, slot_from(i, i) - first, motion_.data(),
               sum.data());
    for (std::size_t k = 0; k < 8; ++k) {
      right_[8 * i + k] = force[k];
      motion_[8 * i + k] = force[k] - sum[k];
    }
  }
  // Each aggregate's equation held at its turn: the residual is what later aggregates added.
  std::fill(group_force_.begin(), group_force_.end(), Real{0});
  for (std::size_t i = 0; i < aggregates(); ++i) {
    const std::size_t above = slot_from(i, i + 1);
    sum_blocks(blocks.data() + kCoarseBlock * above, column.data() + above,
               static_cast<std::size_t>(row_start[i + 1]) - above, motion_.data(), sum.data());
    const Eight<Real> left = times(lift_transposed, i, sum.data());
    for (std::size_t k = 0; k < 6; ++k) group_force_[6 * static_cast<std::size_t>(group[i]) + k] -= left[k];
  }
}

template <class Real>
void CoarseCycle<Real>::add_motions_of_groups(Workers& workers) {
  const std::size_t n = 6 * groups;
  workers.for_chunks(n, kCoarseRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    multiply_top(top.data(), n, group_force_.data(), group_motion_.data(), begin, end);
  });
  for (std::size_t i = 0; i < aggregates(); ++i) {
    const Eight<Real> share = times(lift, i, group_motion_.data() + 6 * static_cast<std::size_t>(group[i]));
    for (std::size_t k = 0; k < 8; ++k) motion_[8 * i + k] += share[k];
  }
}

/// Sweeps in descending order.
template <class Real>
void CoarseCycle<Real>::sweep_backward(std::span<Real> y) {
  Eight<Real> sum;
  for (std::size_t i = aggregates(); i-- > 0;) {
    const auto first = static_cast<std::size_t>(row_start[i]);
    sum_blocks(blocks.data() + kCoarseBlock * first, column.data() + first,
               static_cast<std::size_t>(row_start[i + 1]) - first, motion_.data(), sum.data());
    for (std::size_t k = 0; k < 8; ++k) motion_[8 * i + k] = right_[8 * i + k] - sum[k];
    const Eight<Real> motion = times(basis, i, motion_.data() + 8 * i);
    std::copy_n(motion.begin(), 6, y.begin() + static_cast<std::ptrdiff_t>(6 * i));
  }
}

template <class Real>
void CoarseCycle<Real>::apply(std::span<const Real> c, std::span<Real> y, Workers& workers) {
  right_.resize(8 * aggregates());
  motion_.resize(8 * aggregates());
  group_force_.resize(6 * groups);
  group_motion_.resize(6 * groups);
  sweep_forward(c);
  add_motions_of_groups(workers);
  sweep_backward(y);
}

template struct CoarseCycle<double>;
template struct CoarseCycle<float>;

CoarseCycle<float> rounded(const CoarseCycle<double>& cycle) {
  const auto round = [](const std::vector<double>& from) {
    std::vector<float> to(from.size());
    std::transform(from.begin(), from.end(), to.begin(), [](double value) { return static_cast<float>(value); });
    return to;
  };
  CoarseCycle<float> result;
  result.row_start = cycle.row_start;
  result.column = cycle.column;
  result.blocks = round(cycle.blocks);
  result.basis = round(cycle.basis);
  result.basis_transposed = round(cycle.basis_transposed);
  result.lift = round(cycle.lift);
  result.lift_transposed = round(cycle.lift_transposed);
  result.group = cycle.group;
  result.groups = cycle.groups;
  result.top = round(cycle.top);
  return result;
}

}  // namespace incise
