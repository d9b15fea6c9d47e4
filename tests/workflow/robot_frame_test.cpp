#include <incise/core/error.hpp>
#include <incise/workflow/robot_frame.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

ToolPath one_waypoint_path() {
  ToolPath path;
  Waypoint waypoint{.position_mm = Vec3(1, 2, 3), .axis = Vec3(0, 0, -1)};
  path.waypoints = {waypoint};
  path.tumor_edge.points = {Vec3(1, 0, 0)};
  return path;
}

TEST(InRobotFrame, TurnsAndMovesPointsButOnlyTurnsAxes) {
  Mat4 T = Mat4::Identity();  // a quarter turn about x, then (10, 20, 30)
  T.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  T.topRightCorner<3, 1>() = Vec3(10, 20, 30);
  const ToolPath path = in_robot_frame(one_waypoint_path(), T);
  EXPECT_EQ(path.frame, PathFrame::Robot);
  EXPECT_TRUE(path.waypoints[0].position_mm.isApprox(Vec3(11, 17, 32)));
  EXPECT_TRUE(path.waypoints[0].axis.isApprox(Vec3(0, 1, 0)));
  EXPECT_TRUE(path.tumor_edge.points[0].isApprox(Vec3(11, 20, 30)));
  EXPECT_EQ(*path.T_robot_sim, T);
}

TEST(InRobotFrame, APathThatIsThereAlreadyIsRefused) {
  ToolPath path = one_waypoint_path();
  path.frame = PathFrame::Robot;
  EXPECT_THROW(static_cast<void>(in_robot_frame(path, Mat4::Identity())), InvalidArgument);
}

}  // namespace
}  // namespace incise
