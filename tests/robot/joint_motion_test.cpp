#include "robot/ring_path.hpp"

#include <incise/robot/program.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

namespace incise {
namespace {

using incise::testing::leaning_ring;
using incise::testing::line_path;
using incise::testing::ring_path;

Vec3 tip_of(const RobotProgram& program, const Joints& q) {
  return (forward_kinematics(program.setup.arm, q) * program.setup.T_flange_tool).topRightCorner<3, 1>();
}

TEST(JointMotion, KeepsTheTipSpeedWithinOnePercentAwayFromTheEnds) {
  const RobotProgram program = make_program(leaning_ring());
  const JointMotion& motion = program.motion;
  ASSERT_EQ(motion.outcome, MotionOutcome::Found) << motion.reason;
  const double begin = program.poses[2].time_s + 0.15;
  double end = 0.0;
  for (const auto& pose : program.poses) {
    if (pose.phase == ProgramPhase::Overlap) end = pose.time_s - 0.15;
  }
  std::size_t looked_at = 0;
  for (std::size_t i = 1; i < motion.samples.size(); ++i) {
    if (motion.samples[i - 1].time_s < begin || motion.samples[i].time_s > end) continue;
    const double way = (tip_of(program, motion.samples[i].q_rad) - tip_of(program, motion.samples[i - 1].q_rad)).norm();
    EXPECT_NEAR(way / motion.period_s, 7.0, 0.07) << motion.samples[i].time_s;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 1500u);
}

TEST(JointMotion, ItsSpeedsAndAccelerationsAreTheSlopesOfItsJoints) {
  const RobotProgram program = make_program(leaning_ring());
  const auto& s = program.motion.samples;
  const double h = program.motion.period_s;
  for (std::size_t i = 1; i + 1 < s.size(); ++i) {
    EXPECT_LT(((s[i + 1].q_rad - s[i - 1].q_rad) / (2 * h) - s[i].speed_rad_s).norm(), 1e-3) << i;
    EXPECT_LT(((s[i + 1].q_rad - 2 * s[i].q_rad + s[i - 1].q_rad) / (h * h) - s[i].acceleration_rad_s2).norm(), 0.05)
        << i;
  }
}

TEST(JointMotion, StartsAndEndsAtRestAndNeverJumps) {
  const RobotProgram program = make_program(leaning_ring());
  const auto& s = program.motion.samples;
  EXPECT_LT(s.front().speed_rad_s.norm(), 1e-4);
  EXPECT_LT(s.back().speed_rad_s.norm(), 1e-4);
  for (std::size_t i = 1; i < s.size(); ++i) {
    EXPECT_LT((s[i].speed_rad_s - s[i - 1].speed_rad_s).norm(), 0.03) << i;
    // Jerk: the tip's 2000 mm/s³ at some 600 mm are about 4 rad/s³ a joint; the course's turns add to it.
    EXPECT_LT((s[i].acceleration_rad_s2 - s[i - 1].acceleration_rad_s2).norm() / program.motion.period_s, 60.0) << i;
  }
}

TEST(JointMotion, StaysOnOneBranchWithinItsLimits) {
  const RobotProgram program = make_program(leaning_ring());
  for (const auto& sample : program.motion.samples) {
    const auto inverse = inverse_kinematics(program.setup.arm, forward_kinematics(program.setup.arm, sample.q_rad));
    for (const auto& solution : inverse.solutions) {
      if ((nearest_turns(solution.q_rad, sample.q_rad) - sample.q_rad).norm() < 1e-6) {
        EXPECT_EQ(solution.branch, program.motion.branch);
      }
    }
  }
  EXPECT_GT(program.motion.min_joint_margin_deg, 20.0);
  EXPECT_GT(program.motion.min_singular_value, 0.1);
  EXPECT_GT(program.motion.min_table_clearance_mm, 50.0);
}

TEST(JointMotion, TurnsTheToolAboutItsAxisWhereThatHelps) {
  // A tool whose flange sits far to one side of the needle: held one way the wrist is inside the shoulder.
  ArmSetup setup;
  setup.T_flange_tool(0, 3) = 500.0;
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.position_mm.x() -= 250.0;
  bool is_one_unreachable = false;
  for (double spin = 0.0; spin < 360.0; spin += 30.0) {
    const auto held = make_program(path, {.spin_deg = spin}, setup);
    is_one_unreachable |= held.motion.outcome != MotionOutcome::Found;
    EXPECT_EQ(held.motion.spin_deg, spin);
  }
  EXPECT_TRUE(is_one_unreachable);
  EXPECT_EQ(make_program(path, {}, setup).motion.outcome, MotionOutcome::Found);
}

TEST(JointMotion, NamesTheFirstPoseThatIsOutOfReach) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.position_mm.x() += 750.0;
  const RobotProgram program = make_program(path);
  EXPECT_EQ(program.motion.outcome, MotionOutcome::Unreachable);
  ASSERT_TRUE(program.motion.failed_pose.has_value());
  EXPECT_EQ(program.motion.reason, "too_far");
  EXPECT_TRUE(program.motion.samples.empty());
}

TEST(JointMotion, TakesTheTurnsThatLieNearestToWhereTheArmStands) {
  ArmSetup setup;
  setup.near_rad[5] = 2.0 * units::kPi * 0.9;
  const auto program = make_program(ring_path(), {.spin_deg = 0.0}, setup);
  const auto plain = make_program(ring_path(), {.spin_deg = 0.0});
  const double shift = program.motion.samples[0].q_rad[5] - plain.motion.samples[0].q_rad[5];
  EXPECT_TRUE(std::abs(shift) < 1e-9 || std::abs(std::abs(shift) - 2.0 * units::kPi) < 1e-9 ||
              program.motion.branch != plain.motion.branch);
  EXPECT_LE(std::abs(program.motion.samples[0].q_rad[5] - setup.near_rad[5]), 2.0 * units::kPi);
}

TEST(JointMotion, IsFoundWithinASecond) {
  const std::clock_t start = std::clock();  // of this process: a test machine may be busy with others
  const RobotProgram program = make_program(ring_path());
  EXPECT_EQ(program.motion.outcome, MotionOutcome::Found);
  EXPECT_NEAR(program.cut_length_mm, 94.2, 0.1);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 1.0);
}

}  // namespace
}  // namespace incise
