#include <incise/core/error.hpp>
#include <incise/cutting/tool_program.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

/// A square of side 10 mm on the plane z = 0, 5 mm deep.
ToolPath square(bool is_closed) {
  ToolPath path{.is_closed = is_closed};
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 10, 0), Vec3(0, 10, 0)}) {
    Waypoint waypoint{.position_mm = corner};
    path.waypoints.push_back(waypoint);
  }
  return path;
}

CutSettings ten_mm_per_second() {
  CutSettings settings{.speed_mm_s = 10.0, .overlap_mm = 5.0};
  return settings;
}

TEST(ToolProgram, ARingTakesPlungePerimeterOverlapAndDwell) {
  const ToolProgram program(square(true), ten_mm_per_second(), Needle{});
  EXPECT_NEAR(program.duration_s(), 0.5 + 4.0 + 0.5 + 0.18, 1e-12);
}

TEST(ToolProgram, AnOpenCutHasNoOverlap) {
  const ToolProgram program(square(false), ten_mm_per_second(), Needle{});
  EXPECT_NEAR(program.duration_s(), 0.5 + 3.0 + 0.18, 1e-12);
}

TEST(ToolProgram, TheTipStartsOnTheSurfaceAndPlungesAlongTheAxis) {
  const ToolProgram program(square(true), ten_mm_per_second(), Needle{});
  EXPECT_TRUE(program.pose_at(0.0).tip_mm.isApprox(Vec3(0, 0, 0)));
  EXPECT_NEAR((program.pose_at(0.25).tip_mm - Vec3(0, 0, -2.5)).norm(), 0.0, 1e-12);
  EXPECT_EQ(program.phase_at(0.25), ToolProgram::Phase::Plunge);
  EXPECT_NEAR((program.pose_at(1.0).tip_mm - Vec3(5, 0, -5)).norm(), 0.0, 1e-12);
  EXPECT_EQ(program.phase_at(1.0), ToolProgram::Phase::Follow);
}

TEST(ToolProgram, TheOverlapRunsOnAlongTheStart) {
  const ToolProgram program(square(true), ten_mm_per_second(), Needle{});
  EXPECT_EQ(program.phase_at(4.6), ToolProgram::Phase::Overlap);
  EXPECT_NEAR((program.pose_at(5.0).tip_mm - Vec3(5, 0, -5)).norm(), 0.0, 1e-12);
  EXPECT_EQ(program.phase_at(5.1), ToolProgram::Phase::Dwell);
  EXPECT_NEAR((program.pose_at(99.0).tip_mm - Vec3(5, 0, -5)).norm(), 0.0, 1e-12);
}

TEST(ToolProgram, AnOverlapRunsUpToOnceRoundAndNoFarther) {
  CutSettings settings = ten_mm_per_second();
  EXPECT_DOUBLE_EQ(tip_way_mm(square(true)), 40.0);
  EXPECT_DOUBLE_EQ(tip_way_mm(square(false)), 30.0);
  settings.overlap_mm = 38.0;  // on the last side, which leads back to the first corner
  const ToolProgram program(square(true), settings, Needle{});
  EXPECT_NEAR(program.duration_s(), 0.5 + 4.0 + 3.8 + 0.18, 1e-12);
  EXPECT_NEAR((program.pose_at(99.0).tip_mm - Vec3(0, 2, -5)).norm(), 0.0, 1e-12);
  settings.overlap_mm = 40.0;
  EXPECT_THROW(ToolProgram(square(true), settings, Needle{}), InvalidArgument);
  EXPECT_NO_THROW(ToolProgram(square(false), settings, Needle{})) << "an open cut has none";
}

TEST(ToolProgram, ItMovesAtTheSimulatedSpeedEverywhereButInTheDwell) {
  const ToolProgram program(square(true), ten_mm_per_second(), Needle{});
  for (double t = 0.005; t < 4.99; t += 0.01) {
    if (std::abs(std::fmod(t - 0.5, 1.0)) < 0.011) continue;  // corners
    const double distance = (program.pose_at(t + 0.001).tip_mm - program.pose_at(t).tip_mm).norm();
    EXPECT_NEAR(distance, 0.01, 1e-9) << "at " << t << " s";
  }
}

TEST(ToolProgram, TheLastDwellIsThatOfTheElectrodesPower) {
  CutSettings blunt = ten_mm_per_second();
  blunt.power_w = 0.25 * blunt.reference_power_w;
  CutSettings same = ten_mm_per_second();
  same.dullness *= 4.0;
  EXPECT_DOUBLE_EQ(ToolProgram(square(true), blunt, Needle{}).duration_s(), ToolProgram(square(true), same, Needle{}).duration_s());
  EXPECT_NEAR(ToolProgram(square(true), blunt, Needle{}).duration_s(), 0.5 + 4.0 + 0.5 + 4.0 * 0.18, 1e-12);
}

TEST(ToolProgram, TheWayOfTheTipLeavesOutTurnsAndTheDwell) {
  const ToolProgram program(square(true), ten_mm_per_second(), Blade{});
  EXPECT_NEAR(program.way_mm_at(program.duration_s()), 5.0 + 40.0 + 5.0, 1e-12);
  EXPECT_NEAR(program.way_mm_at(0.25), 2.5, 1e-12);
  EXPECT_EQ(program.way_mm_at(-1.0), 0.0);
}

TEST(ToolProgram, APathThatIsNotInTheStretchedTissueIsRefused) {
  ToolPath path = square(true);
  path.frame = PathFrame::Robot;
  EXPECT_THROW(ToolProgram(path, CutSettings{}, Needle{}), InvalidArgument);
}

TEST(ToolProgram, AnAxisThatIsNoUnitVectorIsRefused) {
  ToolPath path = square(true);
  path.waypoints[2].axis = Vec3(0, 0, -2);
  EXPECT_THROW(ToolProgram(path, CutSettings{}, Needle{}), InvalidArgument);
}

TEST(ToolProgram, ATurnAtACornerTakesABladeTimeAndARoundToolNone) {
  const Blade blade{.width_mm = 4.0};
  const double turns = 4 * 0.5 * M_PI * 2.0;  // mm of its edges: at three corners, and at the start before the overlap
  EXPECT_NEAR(ToolProgram(square(true), ten_mm_per_second(), blade).duration_s(), 0.5 + 4.0 + 0.5 + 0.18 + turns / 10.0, 1e-9);
  EXPECT_NEAR(ToolProgram(square(true), ten_mm_per_second(), Ball{}).duration_s(), 0.5 + 4.0 + 0.5 + 0.18, 1e-12);
}

TEST(ToolProgram, ABladeHeadsAlongThePathInEveryMove) {
  const ToolProgram program(square(true), ten_mm_per_second(), Blade{.width_mm = 4.0});
  EXPECT_NEAR((program.pose_at(0.2).heading - Vec3::UnitX()).norm(), 0.0, 1e-9) << "plunge";
  for (double t = 0.005; t < program.duration_s() - 0.2; t += 0.01) {
    const ToolPose now = program.pose_at(t);
    const Vec3 way = program.pose_at(t + 0.001).tip_mm - now.tip_mm;
    if (std::hypot(way.x(), way.y()) < 0.0099) continue;  // plunge, turn or corner
    EXPECT_NEAR((now.heading - way.normalized()).norm(), 0.0, 1e-6) << "at " << t << " s";
  }
}

TEST(ToolProgram, ALineThatTurnsBackOnItselfTurnsABladeRightRound) {
  ToolPath path = square(false);
  path.waypoints.resize(3);
  path.waypoints[2] = path.waypoints[0];
  const ToolProgram program(path, ten_mm_per_second(), Blade{.width_mm = 4.0});
  EXPECT_NEAR((program.pose_at(program.duration_s()).heading + Vec3::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_NEAR(program.duration_s(), 0.5 + 2.0 + 0.18 + 2.0 * M_PI / 10.0, 1e-9);
}

}  // namespace
}  // namespace incise
