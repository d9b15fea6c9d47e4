#pragma once

#include <incise/geometry/volume.hpp>

#include <cstddef>

namespace incise::meshing_detail {

/// Checks sizes, spacing, origin and direction of a grid, and the count of its voxels.
/// @throws InvalidArgument, with the value found and expected, for a grid that cannot be meshed.
void require_sound(const VolumeGrid& grid, std::size_t voxels);

}  // namespace incise::meshing_detail
