#pragma once

#include <incise/geometry/volume.hpp>

#include <cstddef>

namespace incise::meshing_detail {

/// Checks sizes, spacing, origin and direction of a grid, and the count of its voxels.
/// @throws InvalidArgument, with the value found and expected, for a grid that cannot be meshed.
void require_sound(const VolumeGrid& grid, std::size_t voxels);

/// Returns the box of the voxels for whose offsets `is_in(offset)` is true, in indices.
template <class IsIn>
[[nodiscard]] Eigen::AlignedBox3i box_of_voxels(const VolumeGrid& grid, const IsIn& is_in) {
  Eigen::AlignedBox3i box;
  std::size_t at = 0;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (is_in(at++)) box.extend(Eigen::Vector3i(i, j, k));
      }
    }
  }
  return box;
}

/// Returns a volume with `value_at(offset)` in each voxel of a box, and 0 in a margin around it, which may lie outside
/// the grid. @param box  in indices, not empty.  @param margin  in voxels.
template <class ValueAt>
[[nodiscard]] GrayVolume cut_out(const VolumeGrid& grid, const Eigen::AlignedBox3i& box, int margin,
                                 const ValueAt& value_at) {
  const Eigen::Vector3i low = box.min().array() - margin;
  const Eigen::Vector3i size = box.sizes().array() + 1 + 2 * margin;
  GrayVolume result{grid, {}};
  result.grid.size = {size[0], size[1], size[2]};
  result.grid.origin_mm = grid.world_from_index(low.cast<double>());
  result.voxels.assign(result.grid.voxel_count(), 0.0F);
  for (int k = box.min()[2]; k <= box.max()[2]; ++k) {
    for (int j = box.min()[1]; j <= box.max()[1]; ++j) {
      for (int i = box.min()[0]; i <= box.max()[0]; ++i) {
        result.at(i - low[0], j - low[1], k - low[2]) = value_at(grid.offset(i, j, k));
      }
    }
  }
  return result;
}

}  // namespace incise::meshing_detail
