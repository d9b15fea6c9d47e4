#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>

namespace incise {

/// Returns the surface on which a trilinearly interpolated volume has the value `level`, for pictures: closed, oriented
/// outwards (from greater values to smaller), mm, LPS. Values beyond the volume count as below the level, so a body
/// that the volume's border cuts through is closed there. Surface nets (Gibson 1998): one vertex in each cell that the
/// surface passes, at the mean of its crossings with the cell's edges, and one quadrilateral across each edge that it
/// crosses. Two sheets that pass one cell share its vertex. O(voxels). @throws InvalidArgument for a level or a voxel
/// that is not finite.
[[nodiscard]] TriMesh iso_surface(const GrayVolume& volume, double level);

}  // namespace incise
