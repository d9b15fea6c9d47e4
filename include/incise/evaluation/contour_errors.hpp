#pragma once

#include <incise/geometry/contour.hpp>

#include <vector>

namespace incise {

/// How far each point of an incision lies from the tumour edge, and from where it should be.
struct ContourErrors {
  Contour points;  ///< N x 3, mm: the incision, resampled evenly by arc length; same frame as the input
  std::vector<double> signed_distance_mm;  ///< N: to the tumour edge; negative inside it
  std::vector<double>
      signed_error_mm;  ///< N: signed_distance_mm - target; positive = farther from the tumour than intended
};
inline void describe(Visitor& v, ContourErrors& e) {
  v("points", e.points, "The incision, resampled evenly.");
  v("signed_distance_mm", e.signed_distance_mm, "To the tumour edge; negative inside it.");
  v("signed_error_mm", e.signed_error_mm, "Positive: farther from the tumour than intended.");
}

/// Signed errors of an incision contour against a tumour edge: e_i = ± min_j |p_i − segment_j| − target, with the sign
/// of the distance negative where p_i, seen along the approach, lies inside the edge (so e_i <= -target: the contour
/// has reached the tumour).
/// @param incision   contour as measured, mm; closed or open, at least 2 points (closed: 3) that do not all coincide.
/// @param tumor_edge closed, at least 3 points, mm, same frame.
/// @param target_mm  intended distance of this contour, >= 0: the lateral margin for a mid-line, less the electrode
/// radius for an
///                   inner edge.
/// @param step_mm    spacing of the resampled points, > 0; rounded so that a whole number of steps fits.
/// @throws InvalidArgument for broken preconditions or a number that is not finite.
/// @note O(N M). Source: [Paper, III-A.1]; departs from it: points are spaced evenly, distances go to segments instead
/// of vertices, are measured in space, and keep their sign inside the edge (the paper's |…| makes a cut inside the
/// tumour look like one outside it).
[[nodiscard]] ContourErrors contour_errors(const Contour& incision, const Contour& tumor_edge, double target_mm,
                                           const Vec3& approach, double step_mm = 0.25);

/// The contour resampled evenly with steps near `step_mm`. @pre as contour_errors.
[[nodiscard]] Contour resample_by_step(const Contour& contour, double step_mm);

}  // namespace incise
