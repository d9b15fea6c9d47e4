#pragma once

#include <incise/geometry/contour.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace incise {

/// The outermost closed curve on which a function of the picture plane is zero.
struct LevelLoop {
  std::vector<Vec2> points;  ///< counter-clockwise round the region where the function is negative, mm
  /// Where the curve met a place without a value of the function; `points` ends there. Absent if the curve is complete.
  std::optional<Vec2> undefined_at;
};

/// Traces the outer border of the region {f < 0} from cell to cell of a square grid (marching squares), and places each
/// point on f = 0 by a bracketed search along the grid line. Unlike a flat offset, the result has no loops at concave
/// corners. Enclosed pockets are ignored.
/// @param field     f, mm, of a point, mm; continuous where it has a value; NaN where it has none (counts as outside).
/// @param inside    a point where f < 0, mm.
/// @param reach_mm  > 0; f >= 0 (or NaN) on the line from inside + (reach_mm, 0) onwards in +x.
/// @param step_mm   width of the grid's cells, > 0: features narrower than this may be missed.
/// @throws InvalidArgument if f is not negative at `inside` or is negative at the end of the reach, or if the loop does
/// not close within a million cells.
[[nodiscard]] LevelLoop trace_level_loop(const std::function<double(const Vec2&)>& field, const Vec2& inside,
                                         double reach_mm, double step_mm);

/// Returns the curve at a fixed distance outside a closed contour, in the picture plane along the approach: the contour
/// of an ideal incision in a photograph. Outer loop only; counter-clockwise as the camera sees it. All points lie at
/// the contour's mean height along the approach.
/// @param contour      closed, at least 3 points, finite, mm.
/// @param distance_mm  > 0. Every point has this distance to 1e-9 mm; chords between points are at most 0.36 mm long.
/// @throws InvalidArgument for a contour or distance out of range.
[[nodiscard]] Contour outer_offset(const Contour& contour, double distance_mm, const Vec3& approach);

}  // namespace incise
