#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/types.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace incise {

/// Returns list i of several lists that are stored one after another. @param start  lists + 1, into `items`.
[[nodiscard]] inline std::span<const std::int32_t> list_of(const std::vector<std::int32_t>& start,
                                                           const std::vector<std::int32_t>& items, std::size_t i) {
  const auto first = static_cast<std::size_t>(start[i]);
  return std::span(items).subspan(first, static_cast<std::size_t>(start[i + 1]) - first);
}

/// Sparsity pattern of a matrix of 3x3 blocks, one row and one column of blocks per vertex: compressed rows, columns
/// ascending, diagonal blocks always present.
struct BlockPattern {
  std::vector<std::int32_t> row_start;  ///< N + 1, into `column`: first slot of each row
  std::vector<std::int32_t> column;     ///< per slot: the block's column
  std::vector<std::int32_t> diagonal;   ///< N: slot of block (i, i)
  [[nodiscard]] std::size_t rows() const { return diagonal.size(); }
  [[nodiscard]] std::size_t blocks() const { return column.size(); }
  /// Returns the columns of the blocks of a row, ascending.
  [[nodiscard]] std::span<const std::int32_t> columns_of(std::size_t row) const {
    return list_of(row_start, column, row);
  }
};

/// Symmetric matrix of 3x3 blocks, both triangles stored; values in mN/mm.
struct BlockMatrix {
  std::shared_ptr<const BlockPattern> pattern;  ///< shared: one topology, many matrices
  std::vector<double> values;                   ///< 9 per block, row-major

  explicit BlockMatrix(std::shared_ptr<const BlockPattern> p);
  [[nodiscard]] double* block(std::int32_t slot) { return values.data() + 9 * static_cast<std::size_t>(slot); }
  [[nodiscard]] const double* block(std::int32_t slot) const {
    return values.data() + 9 * static_cast<std::size_t>(slot);
  }
  /// Returns the block of a slot, mN/mm, as a 3x3 matrix that can be assigned and added to.
  [[nodiscard]] auto at(std::int32_t slot) { return Eigen::Map<RowMajor>(block(slot)); }
  [[nodiscard]] auto at(std::int32_t slot) const { return Eigen::Map<const RowMajor>(block(slot)); }

 private:
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
};

/// Computes y = A x; x and y are N x 3. Sums have a fixed order: same bits at any thread count with the same
/// active_isa(). @throws InvalidArgument for vectors of another size.
void multiply(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, Workers& workers);

}  // namespace incise
