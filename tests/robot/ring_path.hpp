#pragma once

#include <incise/core/units.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/robot/checks.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace incise::testing {

/// Names of the checks that failed.
inline std::vector<std::string> failures(const ProgramChecks& checks) {
  std::vector<std::string> names;
  for (const auto& check : checks.checks) {
    if (!check.passed) names.push_back(check.name);
  }
  return names;
}

/// A ring of 15 mm radius, 600 mm in front of the robot, around a circular tumour edge of 10 mm radius: 5 mm deep,
/// straight down, 7 mm/s.
inline ToolPath ring_path(std::size_t waypoints = 48) {
  const Vec3 center(600.0, 0.0, 100.0);
  ToolPath path{.frame = PathFrame::Robot};
  for (std::size_t i = 0; i < waypoints; ++i) {
    const double angle = 2.0 * units::kPi * static_cast<double>(i) / static_cast<double>(waypoints);
    const Vec3 outwards(std::cos(angle), std::sin(angle), 0.0);
    path.waypoints.push_back({center + 15.0 * outwards, -Vec3::UnitZ(), 5.0, 7.0});
    path.tumor_edge.points.push_back(center + 10.0 * outwards);
  }
  return path;
}

/// The same ring with the tool leaning outwards by 0.3 (17 degrees).
inline ToolPath leaning_ring() {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) {
    const Vec3 outwards = (waypoint.position_mm - Vec3(600.0, 0.0, 100.0)).normalized();
    waypoint.axis = (-Vec3::UnitZ() + 0.3 * outwards).normalized();
  }
  return path;
}

/// A straight open cut of 20 mm along x at 100 mm height.
inline ToolPath line_path() {
  ToolPath path{.frame = PathFrame::Robot, .is_closed = false};
  for (int i = 0; i < 5; ++i) path.waypoints.push_back({Vec3(500.0 + 5.0 * i, 0.0, 100.0), -Vec3::UnitZ(), 5.0, 4.0});
  return path;
}

}  // namespace incise::testing
