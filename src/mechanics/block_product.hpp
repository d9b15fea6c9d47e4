#pragma once

#include <incise/mechanics/block_matrix.hpp>

namespace incise {

/// Rows of a block matrix that one thread takes at a time: enough work to pay for the hand-over.
inline constexpr std::size_t kRowsPerChunk = 512;

/// Rows [begin, end) of y = A x.
inline void multiply_rows(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, std::size_t begin,
                          std::size_t end) {
  const std::int32_t* column = matrix.pattern->column.data();
  const std::int32_t* row_start = matrix.pattern->row_start.data();
  for (std::size_t row = begin; row < end; ++row) {
    double sum_x = 0.0;
    double sum_y = 0.0;
    double sum_z = 0.0;
    const auto first = static_cast<std::size_t>(row_start[row]);
    const auto last = static_cast<std::size_t>(row_start[row + 1]);
    const double* a = matrix.values.data() + 9 * first;
    for (std::size_t slot = first; slot < last; ++slot, a += 9) {
      const double* v = x[static_cast<std::size_t>(column[slot])].data();
      sum_x += a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
      sum_y += a[3] * v[0] + a[4] * v[1] + a[5] * v[2];
      sum_z += a[6] * v[0] + a[7] * v[1] + a[8] * v[2];
    }
    y[row] = Vec3(sum_x, sum_y, sum_z);
  }
}

}  // namespace incise
