#include "meshing/grid_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/meshing/occupancy.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace incise {
namespace {

struct IndexBox {
  std::array<int, 3> low{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(),
                         std::numeric_limits<int>::max()};
  std::array<int, 3> high{-1, -1, -1};
};

template <class Visit>
void for_each_voxel(const VolumeGrid& grid, const Visit& visit) {
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) visit(std::array{i, j, k});
    }
  }
}

IndexBox box_of_labelled(const LabelVolume& labels) {
  IndexBox box;
  for_each_voxel(labels.grid, [&](const std::array<int, 3>& at) {
    if (labels.at(at[0], at[1], at[2]) == 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], at[axis]);
      box.high[axis] = std::max(box.high[axis], at[axis]);
    }
  });
  return box;
}

}  // namespace

GrayVolume occupancy_of(const LabelVolume& labels, double sigma_voxels) {
  meshing_detail::require_sound(labels.grid, labels.voxels.size());
  INCISE_REQUIRE(sigma_voxels >= 0.0 && sigma_voxels <= 10.0,
                 fmt::format("sigma_voxels: found {}, expected 0 to 10", sigma_voxels));
  const IndexBox box = box_of_labelled(labels);
  INCISE_REQUIRE(box.high[0] >= 0, "labels: found no voxel other than 0, expected a labelled body");

  const int margin = gaussian_reach(sigma_voxels) + 1;
  GrayVolume result;
  result.grid = labels.grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.grid.size[axis] = box.high[axis] - box.low[axis] + 1 + 2 * margin;
  }
  const std::array<int, 3> shift{box.low[0] - margin, box.low[1] - margin, box.low[2] - margin};
  result.grid.origin_mm = labels.grid.world_from_index(Vec3(shift[0], shift[1], shift[2]));
  result.voxels.assign(result.grid.voxel_count(), 0.0F);
  for_each_voxel(result.grid, [&](const std::array<int, 3>& at) {
    const std::array<int, 3> from{at[0] + shift[0], at[1] + shift[1], at[2] + shift[2]};
    if (labels.grid.contains(from[0], from[1], from[2]) && labels.at(from[0], from[1], from[2]) != 0) {
      result.at(at[0], at[1], at[2]) = 1.0F;
    }
  });
  blur(result, sigma_voxels);
  return result;
}

}  // namespace incise
