#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <span>
#include <vector>

namespace incise {

/// A tet of a split mesh: it holds a part of the tissue of a tet of the whole mesh and has its own corners.
struct SplitTet {
  TetId whole;         ///< its tet of the whole mesh
  Tet corners;         ///< in the split mesh: each is the whole tet's vertex or a copy of it, in the same order
  double share = 1.0;  ///< of the whole tet's rest volume, [0, 1]; the shares of one whole tet add up to 1
  [[nodiscard]] bool operator==(const SplitTet&) const = default;
};
inline void describe(Visitor& v, SplitTet& t) {
  v("whole", t.whole, "The tet of the whole mesh.");
  v("corners", t.corners, "Corners in the split mesh.");
  v("share", t.share, "Share of the whole tet's rest volume.", {0.0, 1.0});
}

/// The splits of a mesh along cuts that run through its tets (virtual nodes: Molino, Bao and Fedkiw 2004). A tet whose
/// tissue has come apart occurs once for each part, and parts share a vertex where their tissue is connected. Vertices
/// and tets of the whole mesh keep their numbers; copies follow.
struct MeshSplits {
  std::vector<VertexId> vertices;  ///< per copied vertex: its original, with a lower number; may be a copy itself
  std::vector<SplitTet> copies;    ///< per copied tet
  std::vector<SplitTet> changed;   ///< tets of the whole mesh with copies, other corners or a smaller share, ascending
  [[nodiscard]] bool operator==(const MeshSplits&) const = default;
};
inline void describe(Visitor& v, MeshSplits& s) {
  v("vertices", s.vertices, "For each copied vertex, the vertex that it was split from.");
  v("copies", s.copies, "The copied tets.");
  v("changed", s.changed, "Tets of the whole mesh with other corners or a smaller share, ascending.");
}

/// Checks that splits belong to a mesh. @throws InvalidArgument for numbers out of range, corners that are not the
/// tet's own or copies of them, shares that do not add up to 1, changed tets that are not ascending, and copies of a
/// tet that is not among them.
void require_splits_of(const TetMesh& whole, const MeshSplits& splits);

/// Returns the split mesh; a copy has its original's position and data.
/// @throws InvalidArgument as require_splits_of.
[[nodiscard]] TetMesh split_mesh(const TetMesh& whole, const MeshSplits& splits);

/// Returns one position for each vertex of the split mesh; a copy has its original's position.
[[nodiscard]] Points split_positions(std::span<const Vec3> whole, const MeshSplits& splits);

/// Returns, for each vertex of the split mesh, its vertex of the whole mesh.
/// @param whole_count  vertices of the whole mesh
[[nodiscard]] std::vector<VertexId> whole_vertices(std::size_t whole_count, const MeshSplits& splits);

/// Returns the share of its whole tet's rest volume that a tet of the split mesh holds, [0, 1]. O(log M).
/// @param whole_count  tets of the whole mesh
[[nodiscard]] double share_of(const MeshSplits& splits, std::size_t whole_count, TetId tet);

}  // namespace incise
