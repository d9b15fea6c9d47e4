#include "registration/shape_residual.hpp"

#include <incise/core/median.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace incise {
namespace {

constexpr double kNeighbourhood = 0.2;    // radius of a neighbourhood, in radii of the target: 10 mm across on a tongue
constexpr std::size_t kFewest = 8;        // target points in a neighbourhood, for noise to average out
constexpr double kFarthestFromSource = 0.15;  // in radii of the target: anything farther away is another object
constexpr double kUsualSettling = 0.035;  // in radii of the target: 1 mm on a tongue
constexpr double kOfMedian = 1.2533;      // standard error of a median over that of a mean, for normal noise
constexpr double kOfDeviation = 1.4826;   // standard deviation over the median absolute deviation, for normal noise
constexpr double kNineTenths = 1.645;     // standard deviations within which nine tenths of normal noise lie
constexpr double kShare = 0.9;            // of the neighbourhoods: the rest may be a rim, a hole or a hair

/// Height of a target point above the source's surface, along the normal of the source's nearest point.
struct HeightThere {
  Vec3 place = Vec3::Zero();
  double value = 0.0;
};

std::vector<HeightThere> heights(const PointCloud& source, const SampledSurface& target) {
  const NeighbourSearch search(source.points);
  std::vector<double> apart;  // of the source's points
  for (const Vec3& p : source.points) apart.push_back(std::sqrt(search.nearest(p, 2).back().squared_mm2));
  const double beside = kEdgeSpacings * median(apart);
  std::vector<HeightThere> found;
  for (const Vec3& p : target.cloud.points) {
    const std::size_t nearest = search.nearest(p).index;
    const Vec3 offset = p - source.points[nearest];
    const double height = offset.dot(source.normals[nearest]);
    if (std::abs(height) > kFarthestFromSource || (offset - height * source.normals[nearest]).norm() > beside) continue;
    found.push_back({p, height});
  }
  return found;
}

/// Returns the part of the heights' median that noise does not explain: the median less 1.645 standard errors, in
/// squares.
double beyond_noise(std::vector<double> heights) {
  const double common = median(heights);
  for (double& height : heights) height = std::abs(height - common);
  const double error = kOfMedian * kOfDeviation * median(heights) / std::sqrt(static_cast<double>(heights.size()));
  return std::sqrt(std::max(0.0, common * common - std::pow(kNineTenths * error, 2)));
}

/// Returns the common height in the neighbourhood of each of the source's points that has enough target points nearby.
std::vector<double> common_heights(const Points& around, const std::vector<HeightThere>& heights) {
  std::vector<double> sizes;
  if (heights.empty()) return sizes;
  Points places;
  for (const HeightThere& one : heights) places.push_back(one.place);
  const NeighbourSearch search(places);
  std::vector<double> near;
  for (const Vec3& center : around) {
    near.clear();
    for (const Neighbour& other : search.within(center, kNeighbourhood)) near.push_back(heights[other.index].value);
    if (near.size() < kFewest) continue;
    sizes.push_back(beyond_noise(near));
  }
  return sizes;
}

}  // namespace

ShapeResidual shape_residual(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
                             const ScaleRange& scale, double settling, Workers& workers) {
  const SettlingSettings settings{.scale = scale, .largest = std::max(settling, kUsualSettling)};
  const SettledPose settled = settled_pose(source, target, start, settings, workers);
  if (settled.is_degenerate) return {};
  std::vector<double> sizes = common_heights(settled.settled.points, heights(settled.settled, target));
  if (sizes.empty()) return {};
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), at, sizes.end());
  return {*at, settled.apart_rms, settled.apart_largest, settled.settled_rms};
}

}  // namespace incise
