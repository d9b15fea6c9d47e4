#include <incise/core/units.hpp>
#include <incise/workflow/ring_covariates.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace incise {
namespace {

/// Direction of the pull across the approach, unit length.
Vec3 pull_direction(const TissueModel& model, const ViewFrame& view) {
  Vec3 farthest = Vec3::Zero();
  for (const Constraint& constraint : model.constraints) {
    const auto* pulled = std::get_if<DisplacedConstraint>(&constraint);
    if (pulled == nullptr) continue;
    const Vec3 across = pulled->displacement_mm - view.z * view.z.dot(pulled->displacement_mm);
    if (across.norm() > farthest.norm()) farthest = across;
  }
  return farthest.norm() > 0.0 ? Vec3(farthest.normalized()) : view.y;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
};

Extent extent_along(const Points& positions, const Vec3& direction) {
  Extent extent;
  for (const Vec3& p : positions) {
    extent.low = std::min(extent.low, p.dot(direction));
    extent.high = std::max(extent.high, p.dot(direction));
  }
  return extent;
}

}  // namespace

RingCovariates ring_covariates(const Case& settings, const TissueModel& model, const Points& positions,
                               const Contour& tumor_edge, double youngs_modulus_kpa) {
  const ViewFrame view = view_along(settings.plan.approach);
  Contour flat = tumor_edge;
  for (Vec3& p : flat.points) p -= view.z * view.z.dot(p);
  const double area_mm2 = std::abs(signed_area_mm2(flat, settings.plan.approach));
  RingCovariates ring;
  ring.radius_mm = std::sqrt(area_mm2 / std::numbers::pi);
  ring.outline = length_mm(flat) / (2.0 * std::numbers::pi * ring.radius_mm);
  const Vec3 middle = curve_centroid(flat), pull = pull_direction(model, view), aside = view.z.cross(pull);
  const Extent length = extent_along(positions, pull), width = extent_along(positions, aside);
  ring.along = (middle.dot(pull) - length.low) / (length.high - length.low);
  ring.aside_mm = middle.dot(aside) - 0.5 * (width.low + width.high);
  ring.youngs_modulus_kpa = youngs_modulus_kpa;
  ring.lateral_margin_mm = settings.plan.lateral_margin_mm;
  ring.depth_mm = settings.plan.depth_mm;
  ring.speed_mm_s = settings.plan.speed_mm_s;
  const Vec3& start = settings.plan.start_direction;
  ring.start_deg = units::deg_from_rad(std::atan2(start.dot(view.y), start.dot(view.x)));
  ring.pull_deg = units::deg_from_rad(std::atan2(pull.dot(view.y), pull.dot(view.x)));
  return ring;
}

}  // namespace incise
