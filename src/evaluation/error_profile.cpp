#include <incise/core/error.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/evaluation/error_profile.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

constexpr double kProfileStepMm = 0.1;

/// As the camera sees it: heights taken out.
Contour flat_in_view(const Contour& contour, const ViewFrame& view) {
  Contour flat{.points = {}, .is_closed = contour.is_closed};
  for (const Vec3& p : contour.points) {
    const Vec3 seen = view.to_view(p);
    flat.points.emplace_back(seen.x(), seen.y(), 0.0);
  }
  return flat;
}

}  // namespace

std::optional<std::vector<double>> error_profile(const Contour& incision, const Contour& tumor_edge,
                                                 const ProfileSettings& settings) {
  INCISE_REQUIRE(settings.sectors >= 4 && settings.sectors <= 360,
                 fmt::format("expected 4 to 360 sectors, found {}", settings.sectors));
  INCISE_REQUIRE(incision.is_closed, "expected a closed incision, found an open one");
  const ViewFrame view = view_along(settings.approach);
  const Vec2 start(settings.start_direction.dot(view.x), settings.start_direction.dot(view.y));
  INCISE_REQUIRE(start.norm() > 1e-9 * settings.start_direction.norm(),
                 "expected a start direction across the approach");
  const Contour edge = flat_in_view(tumor_edge, view);
  const Vec3 down = -Vec3::UnitZ();
  const ContourErrors errors =
      contour_errors(flat_in_view(incision, view), edge, settings.target_mm, down, kProfileStepMm);
  const Vec3 middle = curve_centroid(edge);
  const auto sectors = static_cast<std::size_t>(settings.sectors);
  const double first = std::atan2(start.y(), start.x()) / (2.0 * std::numbers::pi) + settings.turn_deg / 360.0;
  std::vector<double> sums(sectors, 0.0);
  std::vector<double> counts(sectors, 0.0);
  for (std::size_t i = 0; i < errors.points.points.size(); ++i) {
    const Vec3 out = errors.points.points[i] - middle;
    const double turn = std::atan2(out.y(), out.x()) / (2.0 * std::numbers::pi) - first;
    const double place = (turn - std::floor(turn)) * settings.sectors + 0.5;
    const auto sector = static_cast<std::size_t>(place) % sectors;
    sums[sector] += errors.signed_error_mm[i];
    counts[sector] += 1.0;
  }
  for (std::size_t k = 0; k < sectors; ++k) {
    if (counts[k] == 0.0) return std::nullopt;
    sums[k] /= counts[k];
  }
  return sums;
}

}  // namespace incise
