#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/planning/plan_path.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {

ToolPath plan_line(const SurfaceQuery& surface, const Contour& line, const PlanSettings& settings) {
  require_none(validate(settings));
  INCISE_REQUIRE(settings.kind == PlanKind::Line, "expected settings of a line, found those of a ring");
  INCISE_REQUIRE(!line.is_closed && line.points.size() >= 2, "expected an open line of at least 2 points");

  Contour course = line;
  const Vec3& direction = settings.start_direction;
  if (course.points.back().dot(direction) > course.points.front().dot(direction)) {
    std::reverse(course.points.begin(), course.points.end());
  }
  course = resample(course, static_cast<std::size_t>(settings.waypoints));

  const SurfaceView view(surface, settings.approach);
  ToolPath path;
  path.is_closed = false;
  for (std::size_t i = 0; i < course.points.size(); ++i) {
    const Vec2 place = view.place_of(course.points[i]);
    const std::optional<SurfacePoint> seen = view.at(place);
    if (!seen) {
      throw CaseError("plan", "line",
                      fmt::format("a path outside the tissue: waypoint {} at {} mm is beside the surface", i,
                                  in_words(course.points[i])),
                      "a line that stays on the surface, seen along the approach");
    }
    path.waypoints.push_back({.position_mm = seen->position_mm,
                              .axis = view.tool_axis(place, settings.axis_mode),
                              .depth_mm = settings.depth_mm,
                              .speed_mm_s = settings.speed_mm_s});
  }
  check_path_as({"plan", "line", "depth_mm"}, path, surface, settings.approach, settings.rim_clearance_mm);
  return path;
}

}  // namespace incise
