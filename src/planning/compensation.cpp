#include "planning/safe_moves.hpp"
#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/evaluation/hu.hpp>
#include <incise/planning/compensation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace incise {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double positive_angle(double angle) {
  const double turned = std::fmod(angle, kTurn);
  return turned < 0.0 ? turned + kTurn : turned;
}

double polar_angle(const Vec2& place, const Vec2& center) {
  return std::atan2(place.y() - center.y(), place.x() - center.x());
}

/// Angle of each waypoint from the first one's, increasing in [0, 2π).
std::vector<double> sector_angles(const ToolPath& path, const SurfaceView& view, const Vec2& center) {
  std::vector<double> angles;
  const double first = polar_angle(view.place_of(path.waypoints[0].position_mm), center);
  double turned = 0.0;
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const Vec2 place = view.place_of(path.waypoints[i].position_mm);
    const double angle = i == 0 ? 0.0 : positive_angle(polar_angle(place, center) - first);
    if (i > 0 && angle <= turned) {
      throw CaseError("compensation", "path",
                      fmt::format("waypoint {}, at which the path turns back about the "
                                  "tumour's centre",
                                  i),
                      "a path that runs once round the tumour's centre, counter-clockwise",
                      "The paper's correction is not defined for this shape.");
    }
    turned = angle;
    angles.push_back(angle);
  }
  return angles;
}

/// Index in `angles` of the one nearest to `angle`, round the circle.
std::size_t nearest_sector(const std::vector<double>& angles, double angle) {
  const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
  const auto next = static_cast<std::size_t>(above - angles.begin());
  const std::size_t before = next == 0 ? angles.size() - 1 : next - 1;
  const double gap_before = positive_angle(angle - angles[before]);
  const double gap_after = positive_angle((next == angles.size() ? kTurn : angles[next]) - angle);
  return gap_before <= gap_after ? before : next % angles.size();
}

/// Fills sectors without a measured point by linear interpolation over the angle between the nearest sectors with one.
void bridge_gaps(const std::vector<double>& angles, Compensation& result) {
  const std::size_t n = angles.size();
  const std::vector<double> known = result.error_mm;
  for (std::size_t i = 0; i < n; ++i) {
    if (result.is_interpolated[i] == 0) continue;
    std::size_t before = i;
    std::size_t after = i;
    while (result.is_interpolated[before] != 0) before = (before + n - 1) % n;
    while (result.is_interpolated[after] != 0) after = (after + 1) % n;
    const double behind = positive_angle(angles[i] - angles[before]);
    const double ahead = positive_angle(angles[after] - angles[i]);
    result.error_mm[i] = (known[before] * ahead + known[after] * behind) / (behind + ahead);
  }
}

void measure_sectors(const ContourErrors& errors, const std::vector<double>& angles, double first_angle,
                     const SurfaceView& view, const Vec2& center, Compensation& result) {
  std::vector<double> sum(angles.size(), 0.0);
  std::vector<std::size_t> count(angles.size(), 0);
  for (std::size_t k = 0; k < errors.points.points.size(); ++k) {
    const double angle = positive_angle(polar_angle(view.place_of(errors.points.points[k]), center) - first_angle);
    const std::size_t sector = nearest_sector(angles, angle);
    sum[sector] += errors.signed_error_mm[k];
    ++count[sector];
  }
  result.error_mm.assign(angles.size(), 0.0);
  result.is_interpolated.assign(angles.size(), 0);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (count[i] == 0)
      result.is_interpolated[i] = 1;
    else
      result.error_mm[i] = sum[i] / static_cast<double>(count[i]);
  }
  bridge_gaps(angles, result);
}

void smooth(std::vector<double>& values, int passes) {
  const std::size_t n = values.size();
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<double> old = values;
    for (std::size_t i = 0; i < n; ++i)
      values[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
  }
}

void move_waypoints(const SurfaceView& view, const Vec2& center, const CompensationSettings& settings,
                    Compensation& result) {
  const SafeRegion region{.close_margin_mm = settings.close_margin_mm,
                          .electrode_radius_mm = settings.electrode_radius_mm,
                          .max_offset_mm = std::numeric_limits<double>::infinity(),
                          .rim_clearance_mm = settings.rim_clearance_mm,
                          .approach = settings.approach,
                          .axis_mode = settings.axis_mode};
  for (std::size_t i = 0; i < result.path.waypoints.size(); ++i) {
    Waypoint& waypoint = result.path.waypoints[i];
    const Vec2 outward = (view.place_of(waypoint.position_mm) - center).stableNormalized();
    const double wanted =
        -settings.relaxation * result.error_mm[i];  // too close (negative error): away from the tumour
    const double reached = move_waypoint(waypoint, outward, wanted, view, result.path.tumor_edge, region);
    result.move_mm.push_back(reached);
    result.is_limited.push_back(std::abs(wanted) - std::abs(reached) > kMoveToleranceMm ? 1 : 0);
  }
}

}  // namespace

void count_moves(Compensation& compensation) {
  const auto count = [](const std::vector<std::uint8_t>& flags) {
    return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1));
  };
  compensation.limited_waypoints = count(compensation.is_limited);
  compensation.interpolated_waypoints = count(compensation.is_interpolated);
  compensation.max_move_mm = 0.0;
  for (const double move : compensation.move_mm)
    compensation.max_move_mm = std::max(compensation.max_move_mm, std::abs(move));
}

Compensation compensate_paper(const ToolPath& current, const Contour& measured, const Contour& tumor_edge,
                              const SurfaceQuery& surface, const CompensationSettings& settings) {
  require_none(problems_of(settings));
  INCISE_REQUIRE(current.is_closed, "expected a closed path, found an open one");
  check_path_as({"compensation"}, current, surface, settings.approach, 0.0);

  const SurfaceView view(surface, settings.approach);
  const Vec2 center = filled_moments(tumor_edge, settings.approach).centroid_mm;
  const ContourErrors errors =
      contour_errors(measured, tumor_edge, settings.target_mm, settings.approach, settings.step_mm);
  const std::vector<double> angles = sector_angles(current, view, center);
  const double first_angle = polar_angle(view.place_of(current.waypoints[0].position_mm), center);

  Compensation result;
  result.path = current;
  result.path.tumor_edge = tumor_edge;
  result.path.source_sha256.clear();  // it no longer matches the file
  measure_sectors(errors, angles, first_angle, view, center, result);
  smooth(result.error_mm, settings.smoothing_passes);
  move_waypoints(view, center, settings, result);
  count_moves(result);
  check_path_as({"compensation"}, result.path, surface, settings.approach, settings.rim_clearance_mm);
  return result;
}

}  // namespace incise
