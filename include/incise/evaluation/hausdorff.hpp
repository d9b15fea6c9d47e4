#pragma once

#include <incise/geometry/contour.hpp>

namespace incise {

/// How far two curves are from being the same curve, in the picture along the approach. A missing arc, a second cut and
/// a curve that turns back all show here, and not in the errors of the points that were cut.
struct HausdorffDistance {
  double from_first_mm = 0.0;   ///< the farthest that a point of the first curve lies from the second
  double from_second_mm = 0.0;  ///< the farthest that a point of the second lies from the first: a missing arc
  [[nodiscard]] double symmetric_mm() const { return from_first_mm > from_second_mm ? from_first_mm : from_second_mm; }
};
inline void describe(Visitor& v, HausdorffDistance& d) {
  v.derived("symmetric", d.symmetric_mm(), "The greater of the two.");
  v({"from_incision", "Farthest that a point of the first curve lies from the second.", "mm"}, d.from_first_mm);
  v({"from_ideal", "Farthest that a point of the second curve lies from the first.", "mm"}, d.from_second_mm);
}

/// Taken at the corners and at points every `step_mm` between them, to segments: at most step_mm/2 too small.
/// @pre at least 2 points each (3 if closed), a length above 0, finite; step_mm > 0. O(points · segments).
[[nodiscard]] HausdorffDistance hausdorff_distance(const Contour& first, const Contour& second, const Vec3& approach,
                                                   double step_mm);

}  // namespace incise
