#include <incise/core/error.hpp>
#include <incise/cutting/path_heat.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

constexpr double kPowerW = 35.0;

ToolPath path_of(const std::vector<double>& speeds_mm_s, bool is_closed = true) {
  ToolPath path{.is_closed = is_closed};
  for (const double speed : speeds_mm_s) {
    Waypoint waypoint{.speed_mm_s = speed};
    path.waypoints.push_back(waypoint);
  }
  return path;
}

TEST(WidestHeat, IsThatOfTheSlowestWaypointAtEvenDepth) {
  const ThermalSettings tissue;
  const PathHeat heat = widest_heat(tissue, kPowerW, path_of({7.0, 3.0, 0.5, 5.0}), Needle{});
  EXPECT_EQ(heat.waypoint, 2U);
  EXPECT_EQ(heat.half_width_mm, thermal_half_width_mm(tissue, kPowerW, 0.5, 5.0));
  EXPECT_NEAR(heat.half_width_mm, 39.5, 0.5) << "fourteen times the 2.8 mm at 7 mm/s";
}

TEST(WidestHeat, ShallowIsWorseThanDeepAndTheToolsLengthIsTheMost) {
  const ThermalSettings tissue;
  ToolPath path = path_of({7.0, 7.0, 7.0});
  path.waypoints[1].depth_mm = 1.5;
  path.waypoints[2].depth_mm = 0.0;  // out of the tissue
  const PathHeat heat = widest_heat(tissue, kPowerW, path, Needle{});
  EXPECT_EQ(heat.waypoint, 1U);
  EXPECT_EQ(heat.half_width_mm, thermal_half_width_mm(tissue, kPowerW, 7.0, 1.5));
  EXPECT_EQ(widest_heat(tissue, kPowerW, path_of({7.0}), Needle{.length_mm = 2.0}).half_width_mm,
            thermal_half_width_mm(tissue, kPowerW, 7.0, 2.0));
  EXPECT_EQ(widest_heat(tissue, kPowerW, path, Ball{.diameter_mm = 3.0}).half_width_mm,
            thermal_half_width_mm(tissue, kPowerW, 7.0, 3.0));
}

TEST(WidestHeat, TheEndOfAnOpenPathHasNoSpeedOfItsOwn) {
  const ThermalSettings tissue;
  const PathHeat open = widest_heat(tissue, kPowerW, path_of({7.0, 5.0, 0.1}, false), Needle{});
  EXPECT_EQ(open.waypoint, 1U);
  EXPECT_EQ(open.half_width_mm, thermal_half_width_mm(tissue, kPowerW, 5.0, 5.0));
  EXPECT_EQ(widest_heat(tissue, kPowerW, path_of({7.0, 5.0, 0.1}), Needle{}).waypoint, 2U)
      << "a ring goes on to its start";
}

TEST(WidestHeat, APathWithoutWaypointsIsRefused) {
  EXPECT_THROW(static_cast<void>(widest_heat(ThermalSettings{}, kPowerW, ToolPath{}, Needle{})), InvalidArgument);
}

}  // namespace
}  // namespace incise
