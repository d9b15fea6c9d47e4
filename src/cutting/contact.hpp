#pragma once

#include <incise/core/workers.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

/// Corner positions of a tet.
[[nodiscard]] std::array<Vec3, 4> corners_of(const TetMesh& mesh, std::span<const Vec3> positions, std::size_t tet);

/// Live tets whose bounding box, over a step from `before` to `after`, comes within `limit_mm` of the tool's swept box; ascending.
/// A superset of the tets in contact. O(M).
[[nodiscard]] std::vector<TetId> contact_candidates(const TissueModel& model, std::span<const std::uint8_t> is_live,
                                                    std::span<const Vec3> before, std::span<const Vec3> after,
                                                    const ToolPose& tool_before, const ToolPose& tool_after,
                                                    const Needle& needle, double limit_mm, Workers& workers);

/// The share of a tet's volume within `limit_mm` of the segment from a to b, from 35 evenly spread sample points, [0, 1].
[[nodiscard]] double share_within(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b, double limit_mm);

}  // namespace incise
