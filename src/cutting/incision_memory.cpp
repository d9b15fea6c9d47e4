#include <incise/cutting/incision_memory.hpp>

namespace incise {
namespace {

// Bytes per item of the arrays that are held while a cut is under way.
constexpr std::size_t kPerTet =
    16 + 96 + 8 + 16 + 64 + 16  // of the model: corners, gradients, volume, moduli, slots, place with the vertices
    + 190                       // its copy in the order of the kernels
    + 3 * 80 + 16 + 16;         // rotation and mark: stretched, cut and when last assembled; doses; neighbours
constexpr std::size_t kPerVertex = 24 + 8 + 3 + 24 + 12 + 24  // of the model: position, mass, how it is held, load
                                   + 5 * 24  // positions stretched, cut and before the step; right side, increment
                                   + 72 + 216 +
                                   60;  // of the solver: inverse block, vectors, rounding, place in its aggregate
constexpr std::size_t kPerBlock = 8 + 72 + 26 + 1;  // of the matrix: place, numbers, both again in 16 bits, a mark
constexpr std::size_t kPerCoarseNumber = 8 + 4;     // of the coarse inverse, in both precisions

constexpr std::size_t kBlocksPerVertexAveraged =
    90;  // with averaged volume: some 60 vertices at most two edges away, and the averages
constexpr std::size_t kVerticesOfAggregate = 140;
constexpr std::size_t kMostAggregatesWithInverse = 192;  // with more there is a third level, which takes little memory

}  // namespace

std::uint64_t expected_memory_bytes(std::size_t vertices, std::size_t tets, VolumeTreatment volume, int frames,
                                    std::optional<std::size_t> viscous_terms) {
  // By Euler's formula a body has about as many edges as vertices and tets together. Each edge has two blocks, and each
  // vertex one.
  const std::size_t blocks =
      volume == VolumeTreatment::Averaged ? kBlocksPerVertexAveraged * vertices : 3 * vertices + 2 * tets;
  // A tensor for each term and one for the strain, in the stretched tissue and in the cut; three while a step is
  // assembled.
  const std::size_t per_viscous_tet = viscous_terms ? 72 * (2 * (*viscous_terms + 1) + 3) : 0;
  const std::size_t aggregates = vertices / kVerticesOfAggregate + 1;
  const std::size_t coarse = aggregates <= kMostAggregatesWithInverse ? 6 * aggregates : 0;
  return kPerTet * tets + kPerVertex * vertices + kPerBlock * blocks + kPerCoarseNumber * coarse * coarse +
         static_cast<std::size_t>(frames) * 24 * vertices + per_viscous_tet * tets;
}

}  // namespace incise
