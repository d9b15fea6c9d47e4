#pragma once

#include "mechanics/coarse_space.hpp"
#include "mechanics/kernels/kernels.hpp"

#include <incise/core/workers.hpp>
#include <incise/mechanics/block_matrix.hpp>
#include <incise/mechanics/solvers.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace incise {

/// Iteration of TwoLevelPcg in single precision with a matrix of 16 bits per number, because memory traffic limits the
/// speed. Block (i, j) is stored as integers in units of s_i s_j / kWholeOne. s_i is the power of two at or above the
/// square root of the largest number on the diagonal of block (i, i): no number of a positive semi-definite matrix
/// exceeds s_i s_j. Vertices are renumbered to keep those of an aggregate together. Accuracy: see Precision::Single.
class SinglePcg {
 public:
  SinglePcg(std::shared_ptr<const BlockPattern> pattern, const CoarseSpace& coarse);

  /// Rounds the changed rows of the matrix (all rows if changed_rows is empty), the inverses of their diagonal blocks
  /// and, with `has_new_coarse`, the coarse inverse.
  void update(const BlockMatrix& matrix, std::span<const Mat3> inverse_diagonal, const CoarseSpace& coarse,
              bool has_new_coarse, std::span<const std::uint8_t> changed_rows, Workers& workers);
  /// As TwoLevelPcg::solve, for the matrix of the last update.
  PcgReport solve(std::span<const Vec3> b, std::span<Vec3> x, const PcgSettings& settings, Workers& workers);

 private:
  template <class Body>
  void for_aggregates(Workers& workers, const Body& body) const;
  void rescale(const BlockMatrix& matrix, std::span<const std::uint8_t> changed_rows, Workers& workers);
  bool round_row(const BlockMatrix& matrix, std::size_t row);
  PcgVectors vectors();
  void load(std::span<const Vec3> b, bool keeps_last, Workers& workers);
  double share_of_last(Workers& workers);
  void move(float alpha, Workers& workers);
  double precondition(Workers& workers);
  double multiply(Workers& workers);
  void turn(float beta, Workers& workers);

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<std::int32_t> vertex_;  ///< own number -> vertex
  std::vector<std::int32_t> start_;   ///< aggregates + 1, into own numbers
  std::vector<std::int32_t> row_start_, column_;
  std::vector<std::int32_t> source_slot_;  ///< own slot -> slot of the pattern
  std::vector<std::int16_t> values_;       ///< 9 per own slot, and room beyond the end
  std::vector<float> scale_;               ///< s, per vertex
  std::vector<float> left_;  ///< 9 per vertex: rounding errors of the row, summed, in units of s_i s_i / kWholeOne
  std::vector<std::uint8_t> is_stale_;      ///< per vertex: its row must be rounded again
  std::vector<std::uint8_t> is_too_large_;  ///< per vertex: its row has a number too large for a semi-definite matrix
  std::vector<float> inverse_diagonal_;     ///< 12 per vertex: three columns of four
  std::vector<float> arm_, is_free_;        ///< 4 per vertex
  bool is_coarse_dense_;
  bool has_last_ = false;  ///< x_ is the converged solution of the last solve, with the same coarse matrix
  std::vector<float> coarse_;                        ///< n x n, if the coarse inverse is dense
  CoarseCycle<float> cycle_;                         ///< otherwise
  std::vector<float> x_, r_, z_, p_, q_, scaled_p_;  ///< 4 per vertex
  std::vector<float> restricted_, motion_;           ///< n
  std::vector<double> partial_rr_, partial_rz_, partial_pq_;
};

}  // namespace incise
