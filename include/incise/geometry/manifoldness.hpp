#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>
#include <span>

namespace incise {

/// Where a set of triangles fails to be a closed manifold surface. All 0: every edge has two triangles and those round
/// every vertex form one closed fan. The skin of whole tets is without open edges, but its sheets may touch.
struct Manifoldness {
  std::size_t triangles = 0;
  std::size_t open_edges = 0;         ///< with one triangle
  std::size_t nonmanifold_edges = 0;  ///< with more than two: sheets touch along them
  std::size_t pinched_vertices = 0;   ///< where sheets touch in this point alone: more than one fan, and no such edge
  [[nodiscard]] bool is_closed_manifold() const { return open_edges + nonmanifold_edges + pinched_vertices == 0; }
  [[nodiscard]] bool operator==(const Manifoldness&) const = default;
};

/// Counts them. @pre indices in range, no triangle with a corner twice.  O(n log n).
[[nodiscard]] Manifoldness manifoldness_of(std::span<const Triangle> triangles);

}  // namespace incise
