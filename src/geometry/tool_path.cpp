#include <incise/core/error.hpp>
#include <incise/geometry/tool_path.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {

Contour entry_contour(const ToolPath& path) {
  Contour contour{.points = {}, .is_closed = path.is_closed};
  contour.points.reserve(path.waypoints.size());
  for (const Waypoint& waypoint : path.waypoints) contour.points.push_back(waypoint.position_mm);
  return contour;
}

double duration_s(const ToolPath& path) {
  const std::size_t n = path.waypoints.size();
  if (n < 2) return 0.0;
  const auto tip = [&](std::size_t i) -> Vec3 {
    const Waypoint& waypoint = path.waypoints[i];
    return waypoint.position_mm + waypoint.depth_mm * waypoint.axis;
  };
  double duration = 0.0;
  for (std::size_t i = 0; i < (path.is_closed ? n : n - 1); ++i) {
    const double speed = path.waypoints[i].speed_mm_s;
    INCISE_REQUIRE(std::isfinite(speed) && speed > 0.0,
                   fmt::format("waypoint {} has a speed of {} mm/s, expected more than 0", i, speed));
    duration += (tip((i + 1) % n) - tip(i)).norm() / speed;
  }
  return duration;
}

ToolPath unmarked(ToolPath path) {
  path.source_sha256.clear();
  path.specimen_id.clear();
  path.is_virtual = false;
  return path;
}

}  // namespace incise
