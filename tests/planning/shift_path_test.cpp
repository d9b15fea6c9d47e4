#include "planning/bodies.hpp"
#include "support/contour_shapes.hpp"

#include <incise/core/error.hpp>
#include <incise/planning/shift_path.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

class ShiftPath : public ::testing::Test {
 protected:
  SurfaceQuery surface_{testing::flat_body()};
  ToolPath path_ = plan_ring(surface_, testing::circle(10.0, 1440), {.waypoints = 72});
};

TEST_F(ShiftPath, MovesEachWaypointAwayFromTheEdgeByItsOwnOffset) {
  std::vector<double> offset(72, 0.6);
  offset[5] = -1.1;
  const Compensation moved = shift_path(path_, surface_, offset);
  for (std::size_t i = 0; i < 72; ++i) {
    EXPECT_NEAR(moved.path.waypoints[i].position_mm.norm(), 15.0 + offset[i], 1e-3) << i;
    EXPECT_NEAR(moved.move_mm[i], offset[i], 1e-9) << i;
    EXPECT_NEAR(moved.error_mm[i], -offset[i], 1e-12) << "what was to be made good";
  }
  EXPECT_EQ(moved.limited_waypoints, 0U);
  EXPECT_NEAR(moved.max_move_mm, 1.1, 1e-9);
  EXPECT_EQ(moved.path.waypoints[7].depth_mm, path_.waypoints[7].depth_mm);
  EXPECT_EQ(moved.path.waypoints[7].speed_mm_s, path_.waypoints[7].speed_mm_s);
}

TEST_F(ShiftPath, StopsAtTheMarginAndSaysSo) {
  const SafeRegion region;
  const Compensation moved = shift_path(path_, surface_, std::vector<double>(72, -3.0), region);
  const double least = region.close_margin_mm + region.electrode_radius_mm;
  for (const Waypoint& waypoint : moved.path.waypoints) EXPECT_NEAR(waypoint.position_mm.norm() - 10.0, least, 1e-3);
  EXPECT_EQ(moved.limited_waypoints, 72U);
}

TEST_F(ShiftPath, RefusesOffsetsThatDoNotFitThePath) {
  EXPECT_THROW(static_cast<void>(shift_path(path_, surface_, std::vector<double>(71, 0.0))), InvalidArgument);
  std::vector<double> offset(72, 0.0);
  offset[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(shift_path(path_, surface_, offset)), InvalidArgument);
  ToolPath without_edge = path_;
  without_edge.tumor_edge = {};
  EXPECT_THROW(static_cast<void>(shift_path(without_edge, surface_, std::vector<double>(72, 0.0))), InvalidArgument);
}

}  // namespace
}  // namespace incise
