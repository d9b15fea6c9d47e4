#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>

namespace incise {

/// The surface on which a trilinear volume has this value, for pictures: closed, outwards (from greater values to
/// smaller), mm, LPS. Beyond the volume lies less than the level, so a body that the volume cuts through is closed
/// there. Surface nets (Gibson 1998): one vertex in each cell that the surface passes, at the mean of where it crosses
/// the cell's edges, and one quadrilateral across each edge that it crosses. Two sheets that pass one cell share its
/// vertex. O(voxels). @throws InvalidArgument for a value that is not finite.
[[nodiscard]] TriMesh iso_surface(const GrayVolume& volume, double level);

}  // namespace incise
