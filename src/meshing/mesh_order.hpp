#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>

namespace incise::meshing_detail {

/// Returns the mesh with only its largest face-connected set of tets (of equally large ones, that with the lowest tet).
/// Vertices stay, used or not.
/// @param dropped  set to the number of tets removed.
[[nodiscard]] TetMesh largest_component(TetMesh mesh, std::size_t& dropped);

/// Returns the mesh in an order that depends only on its geometry: without unused vertices, vertices along a Morton
/// curve (neighbours in space are near in memory), tets sorted by corners. The corners of a tet ascend, except that the
/// last two are swapped if necessary for a positive volume.
[[nodiscard]] TetMesh in_canonical_order(const TetMesh& mesh);

}  // namespace incise::meshing_detail
