#include "robot/ring_path.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/program.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

using incise::testing::line_path;
using incise::testing::ring_path;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<ProgramPose> poses_of(const RobotProgram& program, ProgramPhase phase) {
  std::vector<ProgramPose> result;
  for (const auto& pose : program.poses) {
    if (pose.phase == phase) result.push_back(pose);
  }
  return result;
}

/// Time from rest to a speed on an S-curve; half of it is lost against the full speed.
double ramp_s(double speed, double a = 100.0, double j = 2000.0) {
  return speed > a * a / j ? speed / a + a / j : 2.0 * std::sqrt(speed / j);
}

TEST(MakeProgram, RefusesSpeedsThatTakeDaysBeforeItSamplesThem) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.speed_mm_s = 1e-6;
  EXPECT_THAT([&] { static_cast<void>(make_program(path)); },
              ThrowsMessage<InvalidArgument>(HasSubstr("takes at most 7200 s, found ")));
}

TEST(MakeProgram, TakesTheTimesThatLengthsSpeedsAndRampsSay) {
  const RobotProgram program = make_program(line_path(), {.approach_height_mm = 30.0,
                                                          .clearance_mm = 5.0,
                                                          .approach_speed_mm_s = 40.0,
                                                          .plunge_speed_mm_s = 10.0,
                                                          .dwell_s = 0.5});
  // Down 25 mm at 40, 10 mm at 10, 20 mm at 4, rest 0.5, up 10 mm at 10, 25 mm at 40; each from rest to rest.
  const double ramps = 2.0 * ramp_s(40.0) + 2.0 * ramp_s(10.0) + ramp_s(4.0);
  EXPECT_NEAR(program.duration_s(), 0.625 + 1.0 + 5.0 + 0.5 + 1.0 + 0.625 + ramps, 1e-9);
  EXPECT_NEAR(program.cut_length_mm, 20.0, 1e-9);
  EXPECT_EQ(program.overlap_mm, 0.0);
  EXPECT_EQ(poses_of(program, ProgramPhase::Dwell).size(), 1u);
}

TEST(MakeProgram, RunsThroughThePhasesInOrder) {
  const RobotProgram program = make_program(ring_path(), {.dwell_s = 0.2});
  std::vector<ProgramPhase> phases;
  for (const auto& pose : program.poses) {
    if (phases.empty() || phases.back() != pose.phase) phases.push_back(pose.phase);
  }
  EXPECT_THAT(phases, ::testing::ElementsAre(ProgramPhase::Approach, ProgramPhase::Plunge, ProgramPhase::Cut,
                                             ProgramPhase::Overlap, ProgramPhase::Dwell, ProgramPhase::Exit,
                                             ProgramPhase::Retreat));
  for (std::size_t i = 1; i < program.poses.size(); ++i)
    EXPECT_GT(program.poses[i].time_s, program.poses[i - 1].time_s);
}

TEST(MakeProgram, ApproachesAndLeavesAboveTheSurface) {
  const RobotProgram program = make_program(ring_path());
  EXPECT_NEAR((program.poses.front().tip_mm - Vec3(615.0, 0.0, 130.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((program.poses[1].tip_mm - Vec3(615.0, 0.0, 105.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((program.poses[2].tip_mm - Vec3(615.0, 0.0, 95.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(program.poses.back().tip_mm.z(), 130.0, 1e-9);
}

TEST(MakeProgram, KeepsTheTipSpeedOnTheRingWithinOnePercentAwayFromItsEnds) {
  const RobotProgram program = make_program(ring_path());
  std::vector<const ProgramPose*> cut;
  for (const auto& pose : program.poses) {
    if (pose.phase == ProgramPhase::Cut || pose.phase == ProgramPhase::Overlap) cut.push_back(&pose);
  }
  for (std::size_t i = 1; i + 1 < cut.size(); ++i) {
    EXPECT_NEAR((cut[i]->tip_mm - cut[i - 1]->tip_mm).norm() / (cut[i]->time_s - cut[i - 1]->time_s), 7.0, 0.07) << i;
  }
}

TEST(MakeProgram, StaysOnTheSmoothRingWithinTheChordError) {
  const RobotProgram program = make_program(ring_path(), {.chord_error_mm = 0.02});
  EXPECT_NEAR(program.cut_length_mm, 2.0 * units::kPi * 15.0, 0.01);
  EXPECT_LE(program.chord_error_mm, 0.02);
  const auto cut = poses_of(program, ProgramPhase::Cut);
  for (std::size_t i = 1; i < cut.size(); ++i) {
    const Vec3 middle = 0.5 * (cut[i].tip_mm + cut[i - 1].tip_mm) - Vec3(600.0, 0.0, 95.0);
    EXPECT_NEAR(middle.norm(), 15.0, 0.021);
  }
}

TEST(MakeProgram, NeedsMorePosesForASmallerChordError) {
  const auto coarse = make_program(ring_path(), {.chord_error_mm = 0.05});
  const auto fine = make_program(ring_path(), {.chord_error_mm = 0.002});
  // The sagitta falls with the square of the spacing: a 25th of the error takes about five times the poses.
  EXPECT_GT(fine.poses.size(), 4 * coarse.poses.size());
}

TEST(MakeProgram, ClosesTheRingAndOverlapsItByTheGivenLength) {
  const RobotProgram program = make_program(ring_path(), {.overlap_mm = 5.0});
  EXPECT_NEAR((poses_of(program, ProgramPhase::Cut).back().tip_mm - program.poses[2].tip_mm).norm(), 0.0, 1e-9);
  const Vec3 end = poses_of(program, ProgramPhase::Overlap).back().tip_mm - Vec3(600.0, 0.0, 95.0);
  EXPECT_NEAR(std::atan2(end.y(), end.x()) * 15.0, 5.0, 0.01);
}

TEST(MakeProgram, GivesTheRotationVectorThatEigenTurnsIntoTheSameRotation) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) {  // tilted outwards by a tenth
    const Vec3 outwards = (waypoint.position_mm - Vec3(600.0, 0.0, 100.0)).normalized();
    waypoint.axis = (-Vec3::UnitZ() + 0.1 * outwards).normalized();
  }
  const RobotProgram program = make_program(path);
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const auto& pose = program.poses[i];
    const double angle = pose.rotation_vector.norm();
    const Mat3 rotation = Eigen::AngleAxisd(angle, pose.rotation_vector / angle).toRotationMatrix();
    EXPECT_LT((rotation - pose.R_robot_tool).norm(), 1e-9) << "pose " << i;
    EXPECT_NEAR(pose.R_robot_tool.determinant(), 1.0, 1e-12);
    const Vec3 step = pose.rotation_vector - program.poses[i > 0 ? i - 1 : 0].rotation_vector;
    EXPECT_LT(step.norm(), 0.1) << "jumps at pose " << i;
  }
}

TEST(MakeProgram, EndsARingTurnedAsItBegan) {
  ToolPath path = ring_path();
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {  // axes that run round a cone
    const Vec3 outwards = (path.waypoints[i].position_mm - Vec3(600.0, 0.0, 100.0)).normalized();
    path.waypoints[i].axis = (-Vec3::UnitZ() + 0.4 * outwards).normalized();
  }
  const auto program = make_program(path, {.overlap_mm = 0.0, .spin_deg = 30.0});
  const auto cut = poses_of(program, ProgramPhase::Cut);
  EXPECT_LT((cut.back().R_robot_tool - program.poses[2].R_robot_tool).norm(), 1e-12);
}

TEST(MakeProgram, RefusesAxesThatPointTheOtherWay) {
  ToolPath path = ring_path();
  path.waypoints[9].axis = Vec3::UnitZ();
  EXPECT_THAT([&] { static_cast<void>(make_program(path)); },
              ThrowsMessage<InvalidArgument>(
                  HasSubstr("within 120 degrees of their mean, found a larger angle at waypoint 9")));
}

TEST(MakeProgram, PointsTheToolAlongTheAxisOfItsWaypoint) {
  const RobotProgram program = make_program(ring_path(), {.spin_deg = 0.0});
  for (const auto& pose : program.poses) EXPECT_NEAR((pose.R_robot_tool.col(2) + Vec3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((program.poses[0].rotation_vector.cwiseAbs() - Vec3(units::kPi, 0, 0)).norm(), 0.0, 1e-9);
}

TEST(MakeProgram, TakesTheSpeedOfEachWaypoint) {
  ToolPath path = line_path();
  path.waypoints[0].speed_mm_s = path.waypoints[1].speed_mm_s = 2.0;  // the first 10 of 20 mm
  const auto program = make_program(path, {.max_spacing_mm = 1.0});
  const auto cut = poses_of(program, ProgramPhase::Cut);
  EXPECT_EQ(cut.front().tip_speed_mm_s, 2.0);
  EXPECT_EQ(cut.back().tip_speed_mm_s, 4.0);
  // From 0 to 2 and from 4 to 0 half of the ramp is lost; from 2 to 4 it is run at 3 in the place of 4.
  const double ramps = 0.5 * ramp_s(2.0) + 0.25 * ramp_s(2.0) + 0.5 * ramp_s(4.0);
  EXPECT_NEAR(cut.back().time_s - program.poses[2].time_s, 10.0 / 2.0 + 10.0 / 4.0 + ramps, 1e-9);
}

TEST(MakeProgram, RefusesAnyFrameButTheRobots) {
  ToolPath path = ring_path();
  path.frame = PathFrame::SimStretched;
  EXPECT_THAT([&] { static_cast<void>(make_program(path)); },
              ThrowsMessage<InvalidArgument>(HasSubstr("robot frame, found sim_stretched")));
  EXPECT_THAT([&] { require_robot_frame(path, "path.json"); },
              ThrowsMessage<DataError>(HasSubstr("path.json: frame: found sim_stretched, expected robot")));
}

TEST(MakeProgram, RefusesWaypointsThatAreNoGood) {
  const auto message = [](auto change) {
    ToolPath path = ring_path();
    change(path);
    return testing::refusal_of<InvalidArgument>([&] { return make_program(path); });
  };
  EXPECT_THAT(message([](ToolPath& p) { p.waypoints[3].position_mm.x() = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("waypoint 3"));
  EXPECT_THAT(message([](ToolPath& p) { p.waypoints[4].axis *= 2.0; }), HasSubstr("unit axis"));
  EXPECT_THAT(message([](ToolPath& p) { p.waypoints[5].speed_mm_s = 0.0; }), HasSubstr("waypoint 5"));
  EXPECT_THAT(message([](ToolPath& p) { p.waypoints[6] = p.waypoints[5]; }), HasSubstr("after waypoint 5"));
  EXPECT_THAT(message([](ToolPath& p) { p.waypoints.resize(2); }), HasSubstr("at least 3 waypoints"));
}

TEST(ValidateProgramSettings, ListsEveryViolation) {
  EXPECT_TRUE(validate(ProgramSettings{}).empty());
  EXPECT_EQ(validate(ProgramSettings{.approach_height_mm = 1.0, .plunge_speed_mm_s = -1.0, .dwell_s = -1.0}).size(),
            3u);
}

}  // namespace
}  // namespace incise
