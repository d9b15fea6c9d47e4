#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/types.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace incise {

/// Which 3x3 blocks of a vertex-by-vertex matrix exist (compressed rows, columns ascending, diagonal always present).
struct BlockPattern {
  std::vector<std::int32_t> row_start;  ///< N + 1
  std::vector<std::int32_t> column;     ///< one per block
  std::vector<std::int32_t> diagonal;   ///< slot of block (i, i), N
  [[nodiscard]] std::size_t rows() const { return diagonal.size(); }
  [[nodiscard]] std::size_t blocks() const { return column.size(); }
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
};

/// A copy in single precision, for products whose errors are put right elsewhere: half the bytes, and the product takes
/// the time its bytes need. Relative rounding 6e-8 of each entry.
struct BlockMatrixF {
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<float> values;  ///< 9 per block, row-major, and 4 zeros: room for one load beyond the end

  explicit BlockMatrixF(std::shared_ptr<const BlockPattern> p);
};
/// Rounds every entry of `matrix` into `result`, a matrix of the same pattern.
void convert(const BlockMatrix& matrix, BlockMatrixF& result, Workers& workers);

/// y = A x. x, y: N x 3. Fixed order: same bits at any thread count with the same active_isa().
void multiply(const BlockMatrix& matrix, std::span<const Vec3> x, std::span<Vec3> y, Workers& workers);
/// The same in single precision, for vectors of four numbers per vertex, the last of which has to be 0 in x and is 0 in y.
void multiply(const BlockMatrixF& matrix, std::span<const Eigen::Vector4f> x, std::span<Eigen::Vector4f> y,
              Workers& workers);

}  // namespace incise
