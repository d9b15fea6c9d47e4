#pragma once

#include <incise/geometry/contour.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace incise {

/// The outermost closed curve on which a function of the picture plane is zero.
struct LevelLoop {
  std::vector<Vec2> points;  ///< counter-clockwise round the region where the function is negative, mm
  /// Set: the curve ran into a place where the function has no value; `points` ends there.
  std::optional<Vec2> undefined_at;
};

/// Follows the border of the region {f < 0} from cell to cell of a square grid (marching squares), and puts each of its
/// points onto f = 0 by a bracketed search along the grid line. Loops that a flat offset would throw at concave corners
/// cannot arise; pockets that are closed off are left out.
/// @param field     f, mm; continuous where it has a value; NaN where it has none (counted as outside).
/// @param inside    a point where f < 0.
/// @param reach_mm  f >= 0 (or NaN) on the line from inside + (reach_mm, 0) onwards in +x.
/// @param step_mm   width of the grid's cells, > 0: features narrower than this may be missed.
/// @throws InvalidArgument if f is not negative at `inside`, or is negative all along the reach, or the loop does not
/// close within a million cells.
[[nodiscard]] LevelLoop trace_level_loop(const std::function<double(const Vec2&)>& field, const Vec2& inside,
                                         double reach_mm, double step_mm);

/// The curve at a fixed distance outside a closed contour, in the picture plane along the approach: what an ideal
/// incision looks like in a photograph. Outer loop only; counter-clockwise seen against the approach; points lie at the
/// contour's mean height along it.
/// @param contour      closed, at least 3 points, finite.
/// @param distance_mm  > 0. Every point keeps it to 1e-9 mm; between points the curve is a chord of at most 0.36 mm.
[[nodiscard]] Contour outer_offset(const Contour& contour, double distance_mm, const Vec3& approach);

}  // namespace incise
