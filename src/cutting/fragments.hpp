#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Live tets of face-connected parts that a change has cut off: parts that hold or border on a tet of `changed` (no
/// longer live, or live with other corners), with less than `least_mm3` of rest volume, that touch no vertex for which
/// `is_anchored` is set; ascending. Looks no farther than it takes to know: O(tets in `least_mm3`).
[[nodiscard]] std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const double> volumes_mm3,
                                                 std::span<const std::array<std::int32_t, 4>> neighbours,
                                                 std::span<const std::uint8_t> is_live,
                                                 std::span<const std::uint8_t> is_anchored,
                                                 std::span<const TetId> changed, double least_mm3);

}  // namespace incise
