#include <incise/core/error.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/evaluation/hausdorff.hpp>

#include <algorithm>

namespace incise {
namespace {

double farthest(const Contour& from, const Contour& to, double step_mm) {
  double result = 0.0;
  for (const Vec3& p : from.points) result = std::max(result, nearest_on(to, p).distance_mm);
  for (const Vec3& p : resample_by_step(from, step_mm).points) result = std::max(result, nearest_on(to, p).distance_mm);
  return result;
}

}  // namespace

HausdorffDistance hausdorff_distance(const Contour& first, const Contour& second, const Vec3& approach,
                                     double step_mm) {
  INCISE_REQUIRE(first.points.size() >= 2 && second.points.size() >= 2, "expected contours of at least 2 points");
  INCISE_REQUIRE(step_mm > 0.0, "expected a step above 0");
  const ViewFrame view = view_along(approach);
  const Contour a = flat_in_view(first, view);
  const Contour b = flat_in_view(second, view);
  return {farthest(a, b, step_mm), farthest(b, a, step_mm)};
}

}  // namespace incise
