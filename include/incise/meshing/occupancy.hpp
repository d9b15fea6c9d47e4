#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>

namespace incise {

/// Returns the fraction of tissue around each voxel, in [0, 1]: every label but 0 counts as tissue, blurred by a
/// Gaussian to keep the staircase of the voxels out of the mesh. The blur preserves the sum over all voxels, the number
/// of labelled voxels. The result's grid covers the labelled part and a margin for the blur.
/// @param sigma_voxels  standard deviation, in voxels along each axis, [0, 10]; 0 = no blur.
/// @throws InvalidArgument for a broken grid, sigma_voxels out of range, or no labelled voxel.
[[nodiscard]] GrayVolume occupancy_of(const LabelVolume& labels, double sigma_voxels = 1.2);

/// Returns the fraction of each voxel that lies inside a closed surface, blurred by a Gaussian of `sigma_voxels`.
/// Voxels are cubes aligned with the world axes. Details smaller than about a voxel are rounded off. Where the surface
/// crosses itself, a region that it encloses twice is inside. A surface turned inside out encloses the same body.
/// @param voxel_mm      edge of a voxel, > 0.
/// @param sigma_voxels  standard deviation, in voxels, [0, 10]; 0 = no blur.
/// @throws InvalidArgument for a surface that is open, not manifold (an edge that does not join exactly two triangles
/// of opposite direction), or not finite, with the place; flat or folded triangles that need repair; an argument out of
/// range; or more than 200 million voxels.
[[nodiscard]] GrayVolume occupancy_of(const TriMesh& closed_surface, double voxel_mm, double sigma_voxels = 0.8);

}  // namespace incise
