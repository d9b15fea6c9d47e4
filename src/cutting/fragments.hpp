#pragma once

#include <incise/geometry/mesh_splits.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// For each tet, the tets that share a face with it. In a split mesh several may share one face: parts of one whole
/// tet, which are not neighbours of each other.
struct FaceAdjacency {
  std::vector<std::int32_t> start;  ///< M + 1: the first item of each tet in `tets`
  std::vector<std::int32_t> tets;   ///< the neighbours of all tets, one tet after the other
  /// Returns the neighbours of a tet.
  [[nodiscard]] std::span<const std::int32_t> of(std::size_t tet) const { return list_of(start, tets, tet); }
};
/// Returns the face adjacency of a mesh. O(M log M).
[[nodiscard]] FaceAdjacency face_adjacency(const TetMesh& mesh);
/// Returns the face adjacency of a split mesh. O(M).
/// @param split  split_mesh of the whole mesh.
/// @param whole  adjacency of the whole mesh.
[[nodiscard]] FaceAdjacency split_adjacency(const TetMesh& split, const MeshSplits& splits, const FaceAdjacency& whole);

/// Returns the live tets of loose fragments: face-connected parts that contain or border on a tet of `changed`, have
/// less than `least_mm3` of rest volume, and touch no vertex with `is_anchored` set; ascending. Each search ends as
/// soon as the answer is known: O(tets in `least_mm3`).
/// @param changed  tets that are no longer live, or are live with other corners.
[[nodiscard]] std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const double> volumes_mm3,
                                                 const FaceAdjacency& neighbours, std::span<const std::uint8_t> is_live,
                                                 std::span<const std::uint8_t> is_anchored,
                                                 std::span<const TetId> changed, double least_mm3);

}  // namespace incise
