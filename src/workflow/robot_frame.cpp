#include <incise/core/error.hpp>
#include <incise/workflow/robot_frame.hpp>

#include <fmt/format.h>

namespace incise {

ToolPath in_robot_frame(ToolPath path, const Mat4& T_robot_sim) {
  INCISE_REQUIRE(path.frame == PathFrame::SimStretched, fmt::format("expected a path in frame sim_stretched, found {}", to_string(path.frame)));
  const Mat3 R = T_robot_sim.topLeftCorner<3, 3>();
  const Vec3 t = T_robot_sim.topRightCorner<3, 1>();
  for (Waypoint& waypoint : path.waypoints) {
    waypoint.position_mm = R * waypoint.position_mm + t;
    waypoint.axis = (R * waypoint.axis).normalized();
  }
  for (Vec3& p : path.tumor_edge.points) p = R * p + t;
  path.frame = PathFrame::Robot;
  path.T_robot_sim = T_robot_sim;
  return path;
}

}  // namespace incise
