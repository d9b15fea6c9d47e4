#pragma once

#include <incise/geometry/contour.hpp>

namespace incise {

/// Hausdorff distances between two curves, in the picture along the approach. They show a missing arc, a second cut and
/// a curve that turns back, which the errors of the points that were cut do not show.
struct HausdorffDistance {
  double from_first_mm = 0.0;   ///< greatest distance of a point of the first curve from the second
  double from_second_mm = 0.0;  ///< greatest distance of a point of the second curve from the first: a missing arc
  [[nodiscard]] double symmetric_mm() const { return from_first_mm > from_second_mm ? from_first_mm : from_second_mm; }
};
inline void describe(Visitor& v, HausdorffDistance& d) {
  v.derived("symmetric", d.symmetric_mm(), "Greater of the two distances.");
  v({"from_incision", "Greatest distance of a point of the first curve from the second.", "mm"}, d.from_first_mm);
  v({"from_ideal", "Greatest distance of a point of the second curve from the first.", "mm"}, d.from_second_mm);
}

/// Computes both Hausdorff distances, from corners and from points about `step_mm` apart to segments: at most step_mm/2
/// too small. O(points · segments).
/// @pre at least 2 points each (3 if closed), a length above 0, finite; step_mm > 0.
[[nodiscard]] HausdorffDistance hausdorff_distance(const Contour& first, const Contour& second, const Vec3& approach,
                                                   double step_mm);

}  // namespace incise
