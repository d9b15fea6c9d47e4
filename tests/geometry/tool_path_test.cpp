#include <incise/core/error.hpp>
#include <incise/geometry/tool_path.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

ToolPath triangle_path() {
  ToolPath path;
  for (const Vec3& p : Points{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}})
    path.waypoints.push_back({.position_mm = p, .speed_mm_s = 2.0});
  return path;
}

TEST(ToolPath, HasTheNamesThatFilesUse) {
  EXPECT_EQ(to_string(PathFrame::SimRest), "sim_rest");
  EXPECT_EQ(to_string(PathFrame::SimStretched), "sim_stretched");
  EXPECT_EQ(to_string(PathFrame::Robot), "robot");
  EXPECT_EQ(to_string(PathKind::Incise), "incise");
  EXPECT_EQ(to_string(PathKind::Mark), "mark");
}

TEST(EntryContour, TakesThePositionsInOrder) {
  ToolPath path = triangle_path();
  path.is_closed = false;
  const Contour contour = entry_contour(path);
  EXPECT_FALSE(contour.is_closed);
  EXPECT_EQ(contour.points, (Points{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}}));
}

TEST(Duration, IsLengthOverSpeedAndIncludesTheClosingSegment) {
  ToolPath path = triangle_path();
  EXPECT_DOUBLE_EQ(duration_s(path), 6.0);  // (3 + 4 + 5) / 2
  path.waypoints[2].speed_mm_s = 5.0;       // from the third waypoint back to the first
  EXPECT_DOUBLE_EQ(duration_s(path), 4.5);
  path.is_closed = false;
  EXPECT_DOUBLE_EQ(duration_s(path), 3.5);
}

TEST(Duration, FollowsTheTipRatherThanTheEntryPoint) {
  ToolPath path = triangle_path();
  path.is_closed = false;
  path.waypoints.resize(2);
  path.waypoints[1].depth_mm = 9.0;  // from 5 to 9 mm deep over 3 mm: the tip travels 5 mm
  EXPECT_DOUBLE_EQ(duration_s(path), 2.5);
}

TEST(Duration, RefusesASpeedThatIsNotPositive) {
  ToolPath path = triangle_path();
  path.waypoints[1].speed_mm_s = 0.0;
  EXPECT_THROW((void)duration_s(path), InvalidArgument);
  EXPECT_DOUBLE_EQ(duration_s(ToolPath{}), 0.0);
}

}  // namespace
}  // namespace incise
