#pragma once

#include <incise/geometry/contour.hpp>

namespace incise {

/// Share of the directions from `center` (in the picture's x and y), [0, 1], in which the contour lies; exact for
/// polylines.
[[nodiscard]] double angular_coverage(const Contour& contour, const Vec2& center, const Vec3& approach);

/// Whether any segment of one contour meets one of the other, seen along the approach.
[[nodiscard]] bool meet_in_view(const Contour& a, const Contour& b, const Vec3& approach);

}  // namespace incise
