#include "robot/ring_path.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/checks.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using incise::testing::line_path;
using incise::testing::ring_path;

std::vector<std::string> failures(const ProgramChecks& checks) {
  std::vector<std::string> names;
  for (const auto& check : checks.checks) {
    if (!check.passed) names.push_back(check.name);
  }
  return names;
}

std::vector<std::string> failures_of(const ToolPath& path, const CheckSettings& settings = {},
                                     const ToolPath* intended = nullptr) {
  return failures(check_program(make_program(path), path, settings, intended));
}

const ProgramCheck& named(const ProgramChecks& checks, const std::string& name) {
  for (const auto& check : checks.checks) {
    if (check.name == name) return check;
  }
  throw std::runtime_error("no check " + name);
}

TEST(CheckProgram, PassesASoundRingAndSaysWhatItFound) {
  const ToolPath path = ring_path();
  const ProgramChecks checks = check_program(make_program(path), path, {}, &path);
  EXPECT_TRUE(checks.all_passed()) << ::testing::PrintToString(failures(checks));
  EXPECT_EQ(checks.checks.size(), 10u);
  EXPECT_NEAR(named(checks, "margin").value, 5.0, 0.05);
  EXPECT_NEAR(named(checks, "speed_max").value, 7.0, 1e-12);
  EXPECT_LT(named(checks, "deviation").value, 0.05);
  // The flange is 150 mm above the tip; farthest at (615, 0, 130 + 150).
  EXPECT_NEAR(named(checks, "reach").value, std::hypot(615.0, 280.0), 0.1);
}

TEST(CheckProgram, SaysWhatNobodyHasLookedAt) {
  const ToolPath path = line_path();
  const auto checks = check_program(make_program(path), path, {.must_be_ring = false});
  EXPECT_TRUE(checks.all_passed());
  const std::string all = ::testing::PrintToString(checks.not_made);
  for (const char* word : {"kinematics", "singularities", "joint limits", "collisions", "margin", "deviation"}) {
    EXPECT_THAT(all, ::testing::HasSubstr(word));
  }
}

TEST(CheckProgram, FindsNumbersThatAreNotFiniteAndLooksNoFurther) {
  const ToolPath path = ring_path();
  RobotProgram program = make_program(path);
  program.poses[7].tip_mm.x() = std::numeric_limits<double>::infinity();
  const auto checks = check_program(program, path);
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("finite"));
  EXPECT_EQ(checks.checks.size(), 1u);
  EXPECT_EQ(checks.checks[0].pose, 7u);
}

TEST(CheckProgram, FindsAnotherFrame) {
  ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  path.frame = PathFrame::SimRest;
  EXPECT_THAT(failures(check_program(program, path)), ::testing::ElementsAre("frame"));
}

TEST(CheckProgram, FindsAnOpenRing) {
  ToolPath path = ring_path();
  path.is_closed = false;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("closed"));
}

TEST(CheckProgram, FindsACourseThatCrossesItself) {
  ToolPath path = ring_path();
  std::swap(path.waypoints[10].position_mm, path.waypoints[13].position_mm);
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("self_crossing"));
}

TEST(CheckProgram, FindsSpeedsOutOfRange) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.speed_mm_s = 31.0;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("speed_max"));
  for (auto& waypoint : path.waypoints) waypoint.speed_mm_s = 0.4;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("speed_min"));
}

TEST(CheckProgram, FindsADepthThatIsNotThePlannedOne) {
  ToolPath path = ring_path();
  path.waypoints[20].depth_mm = 5.8;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("depth"));
}

TEST(CheckProgram, FindsACourseTooCloseToTheTumourEdge) {
  ToolPath path = ring_path();
  path.waypoints[12].position_mm = Vec3(600.0, 12.0, 100.0);  // 2 mm from the edge, on its outside
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("margin"));
}

TEST(CheckProgram, FindsACourseInsideTheTumourEdgeHoweverFarFromIt) {
  ToolPath path = ring_path();
  for (auto& point : path.tumor_edge.points) point = Vec3(600.0, 0.0, 100.0) + 2.0 * (point - Vec3(600.0, 0.0, 100.0));
  const auto checks = check_program(make_program(path), path);
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("margin"));
  EXPECT_LT(named(checks, "margin").value, -4.9);
}

TEST(CheckProgram, FindsADeviationBeyondTheCap) {
  const ToolPath intended = ring_path();
  ToolPath path = intended;
  for (auto& waypoint : path.waypoints) waypoint.position_mm.x() += 1.5;
  EXPECT_TRUE(failures_of(path, {.max_deviation_mm = 1.6}, &intended).empty());
  EXPECT_THAT(failures_of(path, {.max_deviation_mm = 1.4}, &intended), ::testing::ElementsAre("deviation"));
}

TEST(CheckProgram, FindsAPlaceOutOfReach) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.position_mm.x() += 700.0;
  for (auto& point : path.tumor_edge.points) point.x() += 700.0;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("reach"));
}

}  // namespace
}  // namespace incise
