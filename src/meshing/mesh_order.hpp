#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>

namespace incise::meshing_detail {

/// Keeps the largest set of tets joined by faces (the one with the lowest tet, of equally large ones); `dropped` counts
/// the others. Vertices stay, used or not.
[[nodiscard]] TetMesh largest_component(TetMesh mesh, std::size_t& dropped);

/// The same mesh without unused vertices, its vertices along a Morton curve (neighbours in space are neighbours in
/// memory), each tet with ascending corners but for the last two, which make it positive, and tets sorted by corners.
/// Depends on the geometry only.
[[nodiscard]] TetMesh in_canonical_order(const TetMesh& mesh);

}  // namespace incise::meshing_detail
