#pragma once

#include <incise/geometry/contour.hpp>

#include <vector>

namespace incise {

/// Distance of each point of an incision from the tumour edge, and its error.
struct ContourErrors {
  Contour points;  ///< N x 3, mm: the incision, resampled evenly by arc length; same frame as the input
  std::vector<double> signed_distance_mm;  ///< N: to the tumour edge; negative inside it
  std::vector<double>
      signed_error_mm;  ///< N: signed_distance_mm - target; positive = farther from the tumour than intended
};
inline void describe(Visitor& v, ContourErrors& e) {
  v("points", e.points, "The incision, resampled evenly.");
  v("signed_distance_mm", e.signed_distance_mm, "Distance to the tumour edge; negative inside it.");
  v("signed_error_mm", e.signed_error_mm, "Signed error; positive: farther from the tumour than intended.");
}

/// Computes the signed errors of an incision contour against a tumour edge: e_i = ± min_j |p_i − segment_j| − target.
/// The distance is negative if p_i, seen along the approach, lies inside the edge; so e_i <= -target means that the
/// contour has reached the tumour.
/// @param incision   contour as measured, mm; closed or open, at least 2 points (closed: 3) that do not all coincide.
/// @param tumor_edge closed, at least 3 points, mm, same frame.
/// @param target_mm  intended distance of this contour, >= 0: the lateral margin for a mid-line; minus the electrode
///   radius for an inner edge.
/// @param approach   direction in which the camera looks; non-zero.
/// @param step_mm    spacing of the resampled points, > 0; adjusted so that a whole number of steps fits.
/// @throws InvalidArgument for broken preconditions, a number that is not finite, or more than 1e6 steps.
/// @note O(N M). Source: [Paper, III-A.1]. Departs from the paper: points are evenly spaced; distances are measured in
/// space, to segments instead of vertices, and are negative inside the edge (with the paper's |…|, a cut inside the
/// tumour looks like one outside it).
[[nodiscard]] ContourErrors contour_errors(const Contour& incision, const Contour& tumor_edge, double target_mm,
                                           const Vec3& approach, double step_mm = 0.25);

/// Returns the contour resampled evenly, with steps near `step_mm`. Requirements as in contour_errors.
[[nodiscard]] Contour resample_by_step(const Contour& contour, double step_mm);

}  // namespace incise
