#include <incise/core/error.hpp>
#include <incise/evaluation/contour_errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// More points than any contour needs; a tiny step must not exhaust the memory.
constexpr double kMostPoints = 1e6;

}  // namespace

Contour resample_by_step(const Contour& contour, double step_mm) {
  INCISE_REQUIRE(std::isfinite(step_mm) && step_mm > 0.0, fmt::format("expected a step above 0 mm, found {}", step_mm));
  const double steps = std::round(length_mm(contour) / step_mm);
  INCISE_REQUIRE(steps <= kMostPoints,
                 fmt::format("a step of {} mm requires {} points, expected at most 1e6", step_mm, steps));
  const double least = contour.is_closed ? 3.0 : 1.0;
  const auto intervals = static_cast<std::size_t>(std::max(least, steps));
  return resample(contour, contour.is_closed ? intervals : intervals + 1);
}

ContourErrors contour_errors(const Contour& incision, const Contour& tumor_edge, double target_mm, const Vec3& approach,
                             double step_mm) {
  INCISE_REQUIRE(std::isfinite(target_mm) && target_mm >= 0.0,
                 fmt::format("expected a target of 0 mm or more, found {}", target_mm));
  INCISE_REQUIRE(tumor_edge.is_closed && tumor_edge.points.size() >= 3,
                 fmt::format("expected a closed tumour edge of at least 3 points, found {} {}",
                             tumor_edge.is_closed ? "a closed one of" : "an open one of", tumor_edge.points.size()));
  for (std::size_t i = 0; i < tumor_edge.points.size(); ++i) {
    INCISE_REQUIRE(tumor_edge.points[i].allFinite(), fmt::format("point {} of the tumour edge is not finite", i));
  }

  ContourErrors errors{.points = resample_by_step(incision, step_mm), .signed_distance_mm = {}, .signed_error_mm = {}};
  errors.signed_distance_mm.reserve(errors.points.points.size());
  errors.signed_error_mm.reserve(errors.points.points.size());
  for (const Vec3& p : errors.points.points) {
    const double distance = nearest_on(tumor_edge, p).distance_mm;
    const double signed_distance = contains_in_view(tumor_edge, p, approach) ? -distance : distance;
    errors.signed_distance_mm.push_back(signed_distance);
    errors.signed_error_mm.push_back(signed_distance - target_mm);
  }
  return errors;
}

}  // namespace incise
