#pragma once

#include <incise/geometry/mesh_splits.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// The tets that share a face with each. In a split mesh these may be several on one side: parts of one whole tet,
/// which are no neighbours of each other.
struct FaceAdjacency {
  std::vector<std::int32_t> start;  ///< tets + 1, into `tets`
  std::vector<std::int32_t> tets;
  [[nodiscard]] std::span<const std::int32_t> of(std::size_t tet) const {
    const auto first = static_cast<std::size_t>(start[tet]), last = static_cast<std::size_t>(start[tet + 1]);
    return std::span(tets).subspan(first, last - first);
  }
};
/// O(M log M).
[[nodiscard]] FaceAdjacency face_adjacency(const TetMesh& mesh);
/// Of a split mesh: `split` is split_mesh of the mesh that `whole` is of. O(M).
[[nodiscard]] FaceAdjacency split_adjacency(const TetMesh& split, const MeshSplits& splits, const FaceAdjacency& whole);

/// Live tets of face-connected parts that a change has cut off: parts that hold or border on a tet of `changed` (no
/// longer live, or live with other corners), with less than `least_mm3` of rest volume, that touch no vertex for which
/// `is_anchored` is set; ascending. Looks no farther than it takes to know: O(tets in `least_mm3`).
[[nodiscard]] std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const double> volumes_mm3,
                                                 const FaceAdjacency& neighbours, std::span<const std::uint8_t> is_live,
                                                 std::span<const std::uint8_t> is_anchored,
                                                 std::span<const TetId> changed, double least_mm3);

}  // namespace incise
