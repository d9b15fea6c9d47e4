#include "point_lattice.hpp"

#include <incise/cutting/incision_memory.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

// Of a cut by points, found by measurement.
constexpr double kPerPoint = 410.0;         // bytes, most of them while the kerf is measured
constexpr double kEdgesBeyondKernel = 0.6;  // how far tets that the kernel touches reach beyond it

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

std::uint64_t expected_point_memory_bytes(std::uint64_t model_bytes, std::vector<double> volumes_mm3, double length_mm,
                                          double depth_mm, const CutSettings& cut) {
  if (volumes_mm3.empty()) return 0;
  const double body_mm3 = std::accumulate(volumes_mm3.begin(), volumes_mm3.end(), 0.0);
  // A graded mesh has more fine tets than coarse ones: near the path, tets are like the median.
  const auto median = volumes_mm3.begin() + static_cast<std::ptrdiff_t>(volumes_mm3.size() / 2);
  std::nth_element(volumes_mm3.begin(), median, volumes_mm3.end());
  const double edge_mm = std::cbrt(6.0 * std::sqrt(2.0) * *median);  // of a regular tet
  const double reach_mm = cut.kernel_radius_mm + kEdgesBeyondKernel * edge_mm;
  const double touched_mm3 = std::min(body_mm3, length_mm * 2.0 * reach_mm * (depth_mm + reach_mm));
  // Tets with fewer than four nodes have four points of their own beside the nodes.
  const double node_mm3 = std::pow(PointLattice::kSpacingMm, 3);
  const double points = touched_mm3 * (1.0 / node_mm3 + (*median < 4.0 * node_mm3 ? 4.0 / *median : 0.0));
  return model_bytes + static_cast<std::uint64_t>(kPerPoint * points);  // the split mesh is about as large as the whole
}

}  // namespace incise
