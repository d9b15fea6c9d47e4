#pragma once

#include "mechanics/kernels/kernels.hpp"

#include <incise/mechanics/block_matrix.hpp>

namespace incise {

/// Rows of a block matrix that one thread takes at a time: enough work to pay for the hand-over.
inline constexpr std::size_t kRowsPerChunk = 512;

/// Rows [begin, end) of y = A x.
inline void multiply_rows(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, std::size_t begin,
                          std::size_t end) {
  const BlockRows<double> rows{matrix.pattern->row_start.data(), matrix.pattern->column.data(), matrix.values.data()};
  kernels().multiply_double(rows, x.data()->data(), y.data()->data(), begin, end);
}

}  // namespace incise
