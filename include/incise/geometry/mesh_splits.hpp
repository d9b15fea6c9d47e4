#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <span>
#include <vector>

namespace incise {

/// A tet of a split mesh: a tet of the whole mesh, of which it holds a part of the tissue, on corners of its own.
struct SplitTet {
  TetId whole;         ///< of the whole mesh
  Tet corners;         ///< in the split mesh; where a corner is a copy, it is one of the same vertex of the whole mesh
  double share = 1.0;  ///< of the whole tet's rest volume, [0, 1]; those of one whole tet add up to 1
  [[nodiscard]] bool operator==(const SplitTet&) const = default;
};
inline void describe(Visitor& v, SplitTet& t) {
  v("whole", t.whole, "The tet of the whole mesh.");
  v("corners", t.corners, "In the split mesh.");
  v("share", t.share, "Of the whole tet's rest volume.", {0.0, 1.0});
}

/// How a mesh is split along cuts that run through its tets (virtual nodes: Molino, Bao and Fedkiw 2004): a tet whose
/// tissue has come apart is there once for each part, and parts share a vertex where their tissue hangs together.
/// Vertices and tets of the whole mesh keep their numbers, copies follow.
struct MeshSplits {
  std::vector<VertexId> vertices;  ///< per copied vertex: the one that it came apart from, of a lower number
  std::vector<SplitTet> copies;    ///< per copied tet
  std::vector<SplitTet> changed;   ///< tets of the whole mesh with other corners or a smaller share, ascending
  [[nodiscard]] bool operator==(const MeshSplits&) const = default;
};
inline void describe(Visitor& v, MeshSplits& s) {
  v("vertices", s.vertices, "Of each copied vertex, the one that it came apart from.");
  v("copies", s.copies, "The copied tets.");
  v("changed", s.changed, "Tets of the whole mesh with other corners or a smaller share, ascending.");
}

/// @throws InvalidArgument for splits that are not of this mesh: numbers out of range, corners that are no copies of
/// the tet's own, shares that do not add up to 1.
void require_splits_of(const TetMesh& whole, const MeshSplits& splits);

/// The split mesh; a copy has its original's position and data.
/// @throws InvalidArgument as require_splits_of.
[[nodiscard]] TetMesh split_mesh(const TetMesh& whole, const MeshSplits& splits);

/// One position for each vertex of the split mesh, a copy's that of its original.
[[nodiscard]] Points split_positions(std::span<const Vec3> whole, const MeshSplits& splits);

/// Of each vertex of the split mesh, the one of the whole mesh.
[[nodiscard]] std::vector<VertexId> whole_vertices(std::size_t whole_count, const MeshSplits& splits);

/// What a tet of the split mesh holds, of the rest volume of its whole tet. O(log M).
/// @param whole_count  tets of the whole mesh
[[nodiscard]] double share_of(const MeshSplits& splits, std::size_t whole_count, TetId tet);

}  // namespace incise
