#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/cloud_surface.hpp>
#include <incise/planning/plan_marked_path.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kStepMm = 0.5;        // of the triangles that represent the cloud
constexpr double kAroundMm = 4.0;      // of surface beyond the path
constexpr double kMaxGapMm = 2.0;      // in the cloud, under the path
constexpr double kFloorMm = 100.0;     // below the surface: deeper than any cut
constexpr double kMarkOffSurfaceMm = 2.0;  // of the mark, which was measured on this very surface

[[noreturn]] void throw_off(std::size_t i, const Vec3& p) {
  throw CaseError("plan", "mark",
                  fmt::format("a path beyond the measured surface: waypoint {} at {} mm", i, in_words(p)),
                  "measured tissue under the whole path");
}

ToolPath along_mark(const Contour& mark, const CloudSurface& surface, const MarkedPlan& plan) {
  ToolPath path{.frame = PathFrame::Robot, .is_closed = mark.is_closed};
  const PlanSettings& settings = plan.settings;
  const bool turns_round = !mark.is_closed && mark.points.back().dot(settings.start_direction) >
                                                  mark.points.front().dot(settings.start_direction);
  Contour course = mark;
  if (turns_round) std::reverse(course.points.begin(), course.points.end());
  if (mark.is_closed)
    course = start_farthest_along(counter_clockwise(course, settings.approach), settings.start_direction);
  const Contour even = resample(course, static_cast<std::size_t>(settings.waypoints));
  for (std::size_t i = 0; i < even.points.size(); ++i) {
    const std::optional<CloudPlace> place = surface.at(surface.frame().to_view(even.points[i]).head<2>());
    if (!place || place->is_extrapolated || place->gap_mm > kMaxGapMm) throw_off(i, even.points[i]);
    const Vec3 axis = settings.axis_mode == AxisMode::SurfaceNormal ? Vec3(-place->normal) : surface.approach();
    path.waypoints.push_back({place->position_mm, axis, settings.depth_mm, settings.speed_mm_s});
  }
  return path;
}

}  // namespace

ToolPath plan_marked_path(const Contour& mark, std::span<const Vec3> cloud, const MarkedPlan& plan) {
  INCISE_REQUIRE(std::isfinite(plan.margin_mm) && plan.margin_mm >= 0.0,
                 fmt::format("expected a margin of 0 mm or more, found {}", plan.margin_mm));
  INCISE_REQUIRE(mark.points.size() >= 3,
                 fmt::format("expected a mark of at least 3 points, found {}", mark.points.size()));
  PlanSettings settings = plan.settings;
  settings.kind = PlanKind::Ring;
  settings.lateral_margin_mm = plan.margin_mm > 0.0 ? plan.margin_mm : PlanSettings{}.lateral_margin_mm;
  require_none(validate(settings));
  const CloudSurface surface(cloud, settings.approach);
  if (plan.margin_mm <= 0.0) return along_mark(mark, surface, plan);
  INCISE_REQUIRE(mark.is_closed, "expected a closed mark for an incision around it");

  Eigen::AlignedBox2d box;
  for (const Vec3& p : mark.points) box.extend(Vec2(surface.frame().to_view(p).head<2>()));
  const Vec2 around = Vec2::Constant(plan.margin_mm + settings.rim_clearance_mm + kAroundMm);
  const TriMesh body = surface.body(box.min() - around, box.max() + around, kStepMm, kMaxGapMm, kFloorMm);
  if (body.triangles.empty())
    throw CaseError("plan", "mark", "no measured surface about the mark", "measured tissue under the whole path");
  const SurfaceQuery query(body);
  ToolPath path = plan_ring(query, project_tumor_edge(mark, query, settings.approach, kMarkOffSurfaceMm), settings);
  path.frame = PathFrame::Robot;
  return path;
}

}  // namespace incise
