#pragma once

#include "mechanics/chunks.hpp"
#include "mechanics/kernels/kernels.hpp"

#include <incise/mechanics/block_matrix.hpp>

namespace incise {

/// Rows [begin, end) of y = A x.
inline void multiply_rows(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, std::size_t begin,
                          std::size_t end) {
  const BlockRows<double> rows{matrix.pattern->row_start.data(), matrix.pattern->column.data(), matrix.values.data()};
  kernels().multiply_double(rows, x.data()->data(), y.data()->data(), begin, end);
}

}  // namespace incise
