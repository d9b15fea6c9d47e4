#pragma once

#include <incise/geometry/volume.hpp>

#include <cstddef>

namespace incise::meshing_detail {

/// Refuses a grid that cannot be meshed: sizes, spacing, origin, direction, or a voxel count that does not match.
/// @throws InvalidArgument saying what was found and expected.
void require_sound(const VolumeGrid& grid, std::size_t voxels);

}  // namespace incise::meshing_detail
