#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Per tet, the neighbour across each of its four faces (face f is opposite corner f); none: -1. O(M log M).
[[nodiscard]] std::vector<std::array<std::int32_t, 4>> face_neighbours(const TetMesh& mesh);

/// Live tets that belong to a face-connected part with less than `share` of all live tets, unless the part touches a vertex for which
/// `is_anchored` is set; ascending. O(M).
[[nodiscard]] std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const std::array<std::int32_t, 4>> neighbours,
                                                 std::span<const std::uint8_t> is_live,
                                                 std::span<const std::uint8_t> is_anchored, double share);

}  // namespace incise
