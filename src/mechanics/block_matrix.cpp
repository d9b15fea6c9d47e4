#include "mechanics/block_product.hpp"
#include "mechanics/large_pages.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

void require_sizes(std::size_t rows, std::size_t x, std::size_t y) {
  INCISE_REQUIRE(x == rows && y == rows, fmt::format("expected vectors of {} vertices, found {} and {}", rows, x, y));
}

}  // namespace

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> p)
    : pattern(std::move(p)), values(zeros_in_large_pages<double>(9 * pattern->blocks())) {}
BlockMatrixF::BlockMatrixF(std::shared_ptr<const BlockPattern> p)
    : pattern(std::move(p)), values(zeros_in_large_pages<float>(9 * pattern->blocks() + 4)) {}

void convert(const BlockMatrix& matrix, BlockMatrixF& result, Workers& workers) {
  INCISE_REQUIRE(matrix.pattern == result.pattern, "expected two matrices of the same pattern");
  workers.for_each(matrix.values.size(), 9 * kRowsPerChunk * 16,
                   [&](std::size_t i) { result.values[i] = static_cast<float>(matrix.values[i]); });
}

void multiply(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, Workers& workers) {
  const std::size_t rows = matrix.pattern->rows();
  require_sizes(rows, x.size(), y.size());
  workers.for_chunks(rows, kRowsPerChunk,
                     [&](std::size_t, std::size_t begin, std::size_t end) { multiply_rows(matrix, x, y, begin, end); });
}

void multiply(const BlockMatrixF& matrix, std::span<const Eigen::Vector4f> x, std::span<Eigen::Vector4f> y,
              Workers& workers) {
  static_assert(sizeof(Eigen::Vector4f) == 4 * sizeof(float));
  const std::size_t rows = matrix.pattern->rows();
  require_sizes(rows, x.size(), y.size());
  const BlockRows<float> a{matrix.pattern->row_start.data(), matrix.pattern->column.data(), matrix.values.data()};
  workers.for_chunks(rows, kRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    static_cast<void>(kernels().multiply_four(a, x.data()->data(), y.data()->data(), begin, end));
  });
}

}  // namespace incise
