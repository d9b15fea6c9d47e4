#pragma once

#include <incise/geometry/contour.hpp>

namespace incise {

/// Returns the share of directions from `center` (picture's x and y, mm) that meet the contour, [0, 1]; exact for
/// polylines.
[[nodiscard]] double angular_coverage(const Contour& contour, const Vec2& center, const Vec3& approach);

/// Returns whether the contours meet, seen along the approach. O(points of a · points of b).
[[nodiscard]] bool meet_in_view(const Contour& a, const Contour& b, const Vec3& approach);

}  // namespace incise
