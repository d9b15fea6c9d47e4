#pragma once

#include "mechanics/kernels/kernels.hpp"

#include <incise/mechanics/tissue.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace incise {

/// The tets of a model in batches, and these in runs of tets that lie close together. Runs of one colour share no
/// vertex, so threads can add their forces and blocks at the same time. Colours follow one another, and so do the
/// batches of a run: every sum has the same order at any number of threads.
struct TetBatches {
  std::vector<TetBatch> batches;
  std::vector<std::int32_t> run_start;    ///< runs + 1, into `batches`; runs of one colour are contiguous
  std::vector<std::int32_t> color_start;  ///< colours + 1, into the runs
  std::vector<std::int32_t> mirror;       ///< per block of the matrix: slot of its transpose

  [[nodiscard]] std::size_t runs() const { return run_start.size() - 1; }
  [[nodiscard]] std::size_t colors() const { return color_start.size() - 1; }
};

/// Builds the batches from the model's mesh, gradients, volumes, Lamé parameters, pattern and slots.
[[nodiscard]] std::shared_ptr<const TetBatches> make_tet_batches(const TissueModel& model);
/// Builds the batches of the split mesh of a model. Each copy is put into the run of its original, whose neighbours it
/// shares, so runs and colours are those of the whole mesh. O(M).
[[nodiscard]] std::shared_ptr<const TetBatches> make_split_batches(const TissueModel& model, const TissueModel& whole,
                                                                   const MeshSplits& splits);

/// Returns, for each block of a symmetric pattern, the slot of its transpose.
[[nodiscard]] std::vector<std::int32_t> transposed_slots(const BlockPattern& pattern);

/// Copies the transposes of the blocks above the diagonal to those below it, in one row.
void mirror_row(BlockMatrix& matrix, std::span<const std::int32_t> mirror, std::size_t row);
/// Copies the transposes of the blocks above the diagonal to those below it.
void mirror_upper(BlockMatrix& matrix, std::span<const std::int32_t> mirror, Workers& workers);

}  // namespace incise
