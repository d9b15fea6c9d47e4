#include "mechanics/block_product.hpp"
#include "mechanics/large_pages.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <fmt/format.h>

namespace incise {

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> p)
    : pattern(std::move(p)), values(zeros_in_large_pages<double>(9 * pattern->blocks())) {}

void multiply(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, Workers& workers) {
  const std::size_t rows = matrix.pattern->rows();
  INCISE_REQUIRE(x.size() == rows && y.size() == rows,
                 fmt::format("expected vectors of {} vertices, found {} and {}", rows, x.size(), y.size()));
  workers.for_chunks(rows, kRowsPerChunk,
                     [&](std::size_t, std::size_t begin, std::size_t end) { multiply_rows(matrix, x, y, begin, end); });
}

}  // namespace incise
