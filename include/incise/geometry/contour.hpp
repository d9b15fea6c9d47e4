#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <span>
#include <vector>

namespace incise {

/// A polyline in space, mm. Closed: the last point joins the first (and is not a copy of it).
struct Contour {
  Points points;
  bool is_closed = true;
};
inline void describe(Visitor& v, Contour& c) {
  v("points_mm", c.points, "Points in order; on a closed contour, the last joins the first.");
  v("is_closed", c.is_closed, "Whether the last point joins the first.");
}

/// Length, mm, with the segment that closes a closed contour.
[[nodiscard]] double length_mm(const Contour& contour);

/// Returns the arc length of each point from the first, mm; the segment that closes a closed contour is in none.
[[nodiscard]] std::vector<double> arclengths_mm(const Points& points);

/// Returns `count` points evenly spaced by arc length, starting at the first point; an open contour keeps both ends.
/// @pre at least 2 points, positive length, count >= 2 (3 if closed).
[[nodiscard]] Contour resample(const Contour& contour, std::size_t count);

/// The nearest point on a contour's segments.
struct ContourPoint {
  Vec3 position_mm = Vec3::Zero();
  double distance_mm = 0.0;
  std::size_t segment = 0;   ///< from point `segment` to the next
  double fraction = 0.0;     ///< along that segment, [0, 1]
};

/// Returns the point of the contour nearest to p. O(segments). @pre at least 1 point, p finite.
[[nodiscard]] ContourPoint nearest_on(const Contour& contour, const Vec3& p);

/// A right-handed frame that looks along an approach direction: x and y span the picture, z points to the observer.
/// Maps points to view coordinates (x, y, height), mm, and back.
struct ViewFrame {
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z = Vec3::UnitZ();   ///< = -approach
  [[nodiscard]] Vec3 to_view(const Vec3& p) const { return {x.dot(p), y.dot(p), z.dot(p)}; }
  [[nodiscard]] Vec3 from_view(const Vec3& q) const { return x * q.x() + y * q.y() + z * q.z(); }
};

/// Returns the view along `approach`, which need not be unit. For approach (0, 0, -1), x and y are world x and y.
/// @pre approach finite and not zero.
[[nodiscard]] ViewFrame view_along(const Vec3& approach);

/// Returns the contour as seen in the picture: view coordinates, mm, at height 0.
[[nodiscard]] Contour flat_in_view(Contour contour, const ViewFrame& view);

/// Signed area, mm², of a closed contour seen along `approach`: positive = counter-clockwise.
[[nodiscard]] double signed_area_mm2(const Contour& contour, const Vec3& approach);

/// Returns the contour, reversed if necessary, so that it runs counter-clockwise seen along `approach`; the first point
/// stays first.
[[nodiscard]] Contour counter_clockwise(Contour contour, const Vec3& approach);

/// Returns the contour with its start moved to the point that lies farthest along `direction`. @pre closed.
[[nodiscard]] Contour start_farthest_along(Contour contour, const Vec3& direction);

/// Whether the closed polygon, seen along `approach`, contains p (even-odd rule).
[[nodiscard]] bool contains_in_view(const Contour& polygon, const Vec3& p, const Vec3& approach);

/// Whether any two segments that are not neighbours cross or touch, seen along `approach`. O(n²).
[[nodiscard]] bool crosses_itself_in_view(const Contour& contour, const Vec3& approach);

/// Centroid of the curve, mm: mean of the segments' midpoints, weighted by length. @pre at least 1 point.
[[nodiscard]] Vec3 curve_centroid(const Contour& contour);

}  // namespace incise
