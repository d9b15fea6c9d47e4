#include "meshing/body_field.hpp"

#include "meshing/voxel_grids.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace incise::meshing_detail {
namespace {

constexpr float kBodyThreshold = 0.5F;
constexpr float kFaintest = 0.005F;  ///< fainter voxels are background: blurring leaves endless tails
constexpr float kRounding = 0.02F;   ///< recursive Gaussian filters exceed [0, 1] by up to this much
constexpr std::int32_t kNone = -1;

/// Visits the voxels that share a face with a voxel, as offsets in the array.
template <class Visit>
void for_each_neighbour(const VolumeGrid& grid, std::size_t at, const Visit& visit) {
  const auto [i, j, k] = grid.voxel_at(at);
  const auto row = static_cast<std::size_t>(grid.size[0]);
  const std::size_t slice = row * static_cast<std::size_t>(grid.size[1]);
  if (i > 0) visit(at - 1);
  if (i + 1 < grid.size[0]) visit(at + 1);
  if (j > 0) visit(at - row);
  if (j + 1 < grid.size[1]) visit(at + row);
  if (k > 0) visit(at - slice);
  if (k + 1 < grid.size[2]) visit(at + slice);
}

/// Component of each voxel, and the number of voxels of at least 0.5 in each component.
struct Components {
  std::vector<std::int32_t> of_voxel;
  std::vector<std::size_t> sizes;
};

/// Spreads components over voxels of at least `threshold`, breadth first from the voxels already in `queue`.
void spread(const GrayVolume& occupancy, float threshold, std::vector<std::size_t>& queue, Components& found) {
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const std::size_t at = queue[next];
    for_each_neighbour(occupancy.grid, at, [&](std::size_t other) {
      if (found.of_voxel[other] != kNone || occupancy.voxels[other] < threshold) return;
      found.of_voxel[other] = found.of_voxel[at];
      queue.push_back(other);
    });
  }
}

Components find_components(const GrayVolume& occupancy) {
  Components found;
  found.of_voxel.assign(occupancy.voxels.size(), kNone);
  std::vector<std::size_t> bright;
  std::vector<std::size_t> queue;
  for (std::size_t at = 0; at < occupancy.voxels.size(); ++at) {
    if (occupancy.voxels[at] < kBodyThreshold || found.of_voxel[at] != kNone) continue;
    queue.assign(1, at);
    found.of_voxel[at] = static_cast<std::int32_t>(found.sizes.size());
    spread(occupancy, kBodyThreshold, queue, found);
    found.sizes.push_back(queue.size());
    bright.insert(bright.end(), queue.begin(), queue.end());
  }
  spread(occupancy, kFaintest, bright, found);
  return found;
}

void require_fractions(const GrayVolume& occupancy) {
  for (std::size_t at = 0; at < occupancy.voxels.size(); ++at) {
    const float value = occupancy.voxels[at];
    if (value >= -kRounding && value <= 1.0F + kRounding) continue;  // false for NaN
    throw InvalidArgument(fmt::format("occupancy: found {} in voxel {}, expected a fraction in [0, 1]", value, at));
  }
}

double total(const GrayVolume& volume) {
  return std::accumulate(volume.voxels.begin(), volume.voxels.end(), 0.0) * volume.grid.voxel_volume_mm3();
}

}  // namespace

BodyField BodyField::largest_body(const GrayVolume& occupancy, BodyReport& report) {
  require_sound(occupancy.grid, occupancy.voxels.size());
  require_fractions(occupancy);
  const Components components = find_components(occupancy);
  if (components.sizes.empty()) {
    throw InvalidArgument(fmt::format("occupancy: found no voxel of at least {} (the greatest is {}), expected a body",
                                      kBodyThreshold,
                                      *std::max_element(occupancy.voxels.begin(), occupancy.voxels.end())));
  }
  const auto largest = std::max_element(components.sizes.begin(), components.sizes.end()) - components.sizes.begin();
  const auto is_in_body = [&](std::size_t at) { return components.of_voxel[at] == largest; };
  BodyField body;
  body.volume_ = cut_out(occupancy.grid, box_of_voxels(occupancy.grid, is_in_body), 1,
                         [&](std::size_t at) { return is_in_body(at) ? std::min(occupancy.voxels[at], 1.0F) : 0.0F; });
  report.volume_mm3 = total(body.volume_);
  report.dropped_bodies = components.sizes.size() - 1;
  report.dropped_volume_mm3 = std::max(total(occupancy) - report.volume_mm3, 0.0);
  return body;
}

double trilinear(const GrayVolume& volume, const std::array<int, 3>& cell, const Vec3& f) {
  const auto row = static_cast<std::size_t>(volume.grid.size[0]);
  const std::size_t slice = row * static_cast<std::size_t>(volume.grid.size[1]);
  const float* const v = volume.voxels.data() + volume.grid.offset(cell[0], cell[1], cell[2]);
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  const auto along_x = [&](const float* p) { return mix(static_cast<double>(p[0]), static_cast<double>(p[1]), f.x()); };
  return mix(mix(along_x(v), along_x(v + row), f.y()), mix(along_x(v + slice), along_x(v + slice + row), f.y()), f.z());
}

double BodyField::value_at(const Vec3& local) const {
  const VolumeGrid& g = grid();
  std::array<int, 3> cell{};
  Vec3 f;
  for (int axis = 0; axis < 3; ++axis) {
    const double index = local[axis] / g.spacing_mm[axis];
    const int last = g.size[static_cast<std::size_t>(axis)] - 1;
    if (!(index >= 0.0 && index < last)) return 0.0;  // the outermost voxels are 0
    cell[static_cast<std::size_t>(axis)] = static_cast<int>(index);
    f[axis] = index - std::floor(index);
  }
  return trilinear(volume_, cell, f);
}

Box3 BodyField::box() const {
  const auto& n = grid().size;
  return {Vec3::Zero(), local_from_index(Vec3(n[0] - 1, n[1] - 1, n[2] - 1))};
}

Points BodyField::spread_surface_points(double iso, std::size_t count, std::size_t least, double spacing_mm) const {
  constexpr std::size_t kMostCandidates = 5000;
  const VolumeGrid& g = grid();
  Points crossings;
  for (int k = 0; k + 1 < g.size[2]; ++k) {
    for (int j = 0; j + 1 < g.size[1]; ++j) {
      for (int i = 0; i + 1 < g.size[0]; ++i) {
        const double here = static_cast<double>(voxel(i, j, k));
        const std::array<double, 3> there{static_cast<double>(voxel(i + 1, j, k)),
                                          static_cast<double>(voxel(i, j + 1, k)),
                                          static_cast<double>(voxel(i, j, k + 1))};
        for (int axis = 0; axis < 3; ++axis) {
          const double other = there[static_cast<std::size_t>(axis)];
          if ((here > iso) == (other > iso)) continue;
          crossings.push_back(local_from_index(Vec3(i, j, k) + (iso - here) / (other - here) * Vec3::Unit(axis)));
        }
      }
    }
  }
  Points candidates;
  const std::size_t stride = crossings.size() / kMostCandidates + 1;
  for (std::size_t c = 0; c < crossings.size(); c += stride) candidates.push_back(crossings[c]);

  Points chosen;
  std::vector<double> distance(candidates.size(), std::numeric_limits<double>::infinity());
  for (std::size_t next = 0; chosen.size() < std::min(count, candidates.size());) {
    chosen.push_back(candidates[next]);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      distance[c] = std::min(distance[c], (candidates[c] - candidates[next]).norm());
    }
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
    if (distance[next] <= 0.0 || (chosen.size() >= least && distance[next] < spacing_mm)) break;
  }
  return chosen;
}

}  // namespace incise::meshing_detail
