#include <incise/core/error.hpp>
#include <incise/cutting/path_heat.hpp>

#include <algorithm>
#include <optional>

namespace incise {
namespace {

double heated_length_mm(const Tool& tool, double depth_mm) {
  const std::optional<double> length = length_mm(tool);
  return length ? std::min(*length, depth_mm) : 2.0 * radius_mm(tool);
}

}  // namespace

PathHeat widest_heat(const ThermalSettings& settings, double power_w, const ToolPath& path, const Tool& tool) {
  const std::vector<Waypoint>& waypoints = path.waypoints;
  INCISE_REQUIRE(!waypoints.empty(), "expected a path with waypoints, found none");
  PathHeat widest;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    if (waypoints[i].depth_mm <= 0.0) continue;
    const bool is_end = !path.is_closed && i > 0 && i + 1 == waypoints.size();
    const double half_width = thermal_half_width_mm(settings, power_w, waypoints[is_end ? i - 1 : i].speed_mm_s,
                                                    heated_length_mm(tool, waypoints[i].depth_mm));
    if (half_width > widest.half_width_mm) widest = {half_width, i};
  }
  return widest;
}

}  // namespace incise
