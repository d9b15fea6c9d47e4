#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>

namespace incise {

/// The fraction of tissue around each voxel, in [0, 1], from labels: every label but 0 counts as tissue, blurred by a
/// Gaussian so that the staircase of the voxels does not end up in the mesh. The sum over all voxels is the number of
/// labelled voxels (the blur moves tissue, it neither adds nor removes any). The result's grid is cut to the labelled
/// part plus a margin that holds the blur.
/// @param sigma_voxels  standard deviation, in voxels along each axis, [0, 10]; 0 = no blur.
/// @throws InvalidArgument for a broken grid or when no voxel is labelled.
[[nodiscard]] GrayVolume occupancy_of(const LabelVolume& labels, double sigma_voxels = 1.2);

/// The fraction of each voxel that lies inside a closed surface, then blurred by a Gaussian of `sigma_voxels`. Voxels
/// are cubes aligned with the world axes. Edges sharper than about a voxel are rounded. Where the surface crosses
/// itself, what is enclosed twice is inside. A surface turned inside out is accepted: what it encloses is the same.
/// @param voxel_mm  edge of a voxel, > 0.
/// @throws InvalidArgument for a surface that is open, not manifold (an edge that does not join exactly two triangles
/// of opposite direction), or not finite, saying where; and for more than 200 million voxels.
[[nodiscard]] GrayVolume occupancy_of(const TriMesh& closed_surface, double voxel_mm, double sigma_voxels = 0.8);

}  // namespace incise
