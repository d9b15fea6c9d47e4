#include "mechanics/block_product.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <fmt/format.h>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace incise {
namespace {

/// Zeros in large memory pages where the system has them: a product that reads the whole matrix in one go then seldom
/// waits for an address to be looked up, which on a virtual machine takes a third of its time.
template <class Number>
std::vector<Number> zeros(std::size_t count) {
  std::vector<Number> values;
  values.reserve(count);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kPage = 4096;
  constexpr std::size_t kWorthwhile = std::size_t{4} << 20U;
  if (count * sizeof(Number) >= kWorthwhile) {
    const std::size_t begin = (reinterpret_cast<std::uintptr_t>(values.data()) + kPage - 1) / kPage * kPage;
    const std::size_t end = (reinterpret_cast<std::uintptr_t>(values.data()) + count * sizeof(Number)) / kPage * kPage;
    // A mere hint: where it is refused, the pages are small ones and nothing else differs.
    static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE));
  }
#endif
  values.resize(count);
  return values;
}

void require_sizes(std::size_t rows, std::size_t x, std::size_t y) {
  INCISE_REQUIRE(x == rows && y == rows, fmt::format("expected vectors of {} vertices, found {} and {}", rows, x, y));
}

}  // namespace

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> p)
    : pattern(std::move(p)), values(zeros<double>(9 * pattern->blocks())) {}
BlockMatrixF::BlockMatrixF(std::shared_ptr<const BlockPattern> p)
    : pattern(std::move(p)), values(zeros<float>(9 * pattern->blocks())) {}

void convert(const BlockMatrix& matrix, BlockMatrixF& result, Workers& workers) {
  INCISE_REQUIRE(matrix.pattern == result.pattern, "expected two matrices of one pattern");
  workers.for_each(matrix.values.size(), 9 * kRowsPerChunk * 16,
                   [&](std::size_t i) { result.values[i] = static_cast<float>(matrix.values[i]); });
}

void multiply(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, Workers& workers) {
  const std::size_t rows = matrix.pattern->rows();
  require_sizes(rows, x.size(), y.size());
  workers.for_chunks(rows, kRowsPerChunk,
                     [&](std::size_t, std::size_t begin, std::size_t end) { multiply_rows(matrix, x, y, begin, end); });
}

void multiply(const BlockMatrixF& matrix, std::span<const Eigen::Vector3f> x, std::span<Eigen::Vector3f> y,
              Workers& workers) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const std::size_t rows = matrix.pattern->rows();
  require_sizes(rows, x.size(), y.size());
  const BlockRows<float> a{matrix.pattern->row_start.data(), matrix.pattern->column.data(), matrix.values.data()};
  workers.for_chunks(rows, kRowsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    kernels().multiply_float(a, x.data()->data(), y.data()->data(), begin, end);
  });
}

}  // namespace incise
