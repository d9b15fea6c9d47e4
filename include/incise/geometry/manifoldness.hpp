#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>
#include <span>

namespace incise {

/// Counts of the places where a set of triangles fails to be a closed manifold surface. If there are none, every edge
/// has two triangles and the triangles round every vertex form one closed fan. The skin of whole tets has no open
/// edges, but its sheets may touch.
struct Manifoldness {
  std::size_t triangles = 0;          ///< in the set
  std::size_t open_edges = 0;         ///< with one triangle
  std::size_t nonmanifold_edges = 0;  ///< with more than two: sheets touch along them
  std::size_t pinched_vertices = 0;   ///< more than one fan but no such edge: sheets touch in this point alone
  [[nodiscard]] bool operator==(const Manifoldness&) const = default;
};
inline void describe(Visitor& v, Manifoldness& m) {
  v("triangles", m.triangles, "Number of triangles.");
  v("open_edges", m.open_edges, "Number of edges of one triangle only.");
  v("nonmanifold_edges", m.nonmanifold_edges, "Number of edges of more than two triangles: sheets touch along them.");
  v("pinched_vertices", m.pinched_vertices, "Number of vertices where sheets touch only at that point.");
}

/// Counts these places. @pre indices in range, no triangle with a corner twice.  O(n log n).
[[nodiscard]] Manifoldness manifoldness_of(std::span<const Triangle> triangles);

}  // namespace incise
