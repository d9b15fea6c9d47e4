#include "robot/joint_motion.hpp"

#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace robot_detail {
namespace {

constexpr double kDifferenceS = 1e-3;  // 1e-15 rad of rounding causes 1e-9 rad/s² in the second difference
constexpr double kJumpRad = 0.2;       // in one period: 25 rad/s at 8 ms, ten times the speed of any joint

std::size_t pose_at(const RobotProgram& program, double time_s) {
  const auto after = std::upper_bound(program.poses.begin(), program.poses.end(), time_s,
                                      [](double time, const ProgramPose& pose) { return time < pose.time_s; });
  return after == program.poses.begin() ? 0 : static_cast<std::size_t>(after - program.poses.begin()) - 1;
}

void measure(JointMotion& motion, const ArmSetup& setup) {
  motion.min_singular_value = motion.min_joint_margin_deg = motion.min_table_clearance_mm =
      std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < motion.samples.size(); ++i) {
    const Joints& q = motion.samples[i].q_rad;
    const double margin = std::min((q - setup.arm.min_rad).minCoeff(), (setup.arm.max_rad - q).minCoeff());
    motion.min_joint_margin_deg = std::min(motion.min_joint_margin_deg, units::deg_from_rad(margin));
    motion.min_singular_value = std::min(motion.min_singular_value, smallest_singular_value(setup.arm, q));
    motion.min_table_clearance_mm =
        std::min(motion.min_table_clearance_mm, table_clearance_mm(setup.arm, q, setup.table_z_mm));
    if (i > 0) motion.travel_deg += units::deg_from_rad((q - motion.samples[i - 1].q_rad).cwiseAbs().sum());
  }
}

}  // namespace

JointMotion follow_branch(const Course& course, const ToolFrame& frame, const BranchChoice& choice,
                          const RobotProgram& program, const ArmSetup& setup) {
  JointMotion motion;
  motion.outcome = choice.outcome;
  motion.branch = choice.branch;
  motion.spin_deg = choice.spin_deg;
  motion.period_s = setup.period_s;
  const auto fail = [&](MotionOutcome outcome, std::size_t pose, std::string reason) {
    motion.outcome = outcome;
    motion.failed_pose = pose;
    motion.reason = std::move(reason);
    motion.samples.clear();
  };
  if (choice.outcome != MotionOutcome::Found) {
    fail(choice.outcome, choice.failed_pose, std::string(to_string(choice.why)));
    return motion;
  }
  const Mat4 T_tool_flange = setup.T_flange_tool.inverse();
  InverseOutcome outcome = InverseOutcome::Solved;  // why the branch does not reach the last pose
  const auto joints_at = [&](double time_s, const Joints& reference) -> std::optional<Joints> {
    const CourseSample place = course.at(time_s);
    Mat4 T = Mat4::Identity();
    T.topLeftCorner<3, 3>() = frame.at(place.axis);
    T.topRightCorner<3, 1>() = place.tip_mm;
    const InverseResult inverse = inverse_kinematics(setup.arm, T * T_tool_flange, reference[5]);
    outcome = inverse.outcome;
    for (const InverseSolution& solution : inverse.solutions) {
      if (solution.branch == choice.branch) return nearest_turns(solution.q_rad, reference);
    }
    return std::nullopt;
  };
  const auto count = static_cast<std::size_t>(std::ceil(course.duration_s() / setup.period_s - 1e-9));
  Joints last = choice.start_rad;
  for (std::size_t i = 0; i <= count; ++i) {
    const double time = setup.period_s * static_cast<double>(i);
    const auto now = joints_at(time, last);
    const auto before = now ? joints_at(time - kDifferenceS, *now) : now;
    const auto after = before ? joints_at(time + kDifferenceS, *now) : before;
    if (!after) {
      fail(MotionOutcome::Unreachable, pose_at(program, time), std::string(to_string(outcome)));
      return motion;
    }
    const double step = (*now - last).cwiseAbs().maxCoeff();
    if (step > kJumpRad) {
      fail(MotionOutcome::Jump, pose_at(program, time),
           fmt::format("a joint would turn by {:.1f} deg within {} s", units::deg_from_rad(step), setup.period_s));
      return motion;
    }
    motion.samples.push_back({time, *now, (*after - *before) / (2.0 * kDifferenceS),
                              (*after - 2.0 * *now + *before) / (kDifferenceS * kDifferenceS), pose_at(program, time)});
    last = *now;
  }
  measure(motion, setup);
  return motion;
}

}  // namespace robot_detail

std::vector<Problem> validate(const ArmSetup& setup) {
  std::vector<Problem> broken;
  const Expect expect(broken);
  const Mat3 R = setup.T_flange_tool.topLeftCorner<3, 3>();
  const bool is_rigid = setup.T_flange_tool.allFinite() && (R * R.transpose() - Mat3::Identity()).norm() < 1e-6 &&
                        R.determinant() > 0.0 && setup.T_flange_tool.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  expect(is_rigid, "T_flange_tool", R.determinant(), "a rigid transform, of determinant 1");
  for (int i = 0; i < 6; ++i) expect(true, fmt::format("near_rad[{}]", i), setup.near_rad[i], "a finite angle");
  expect(true, "table_z_mm", setup.table_z_mm, "a finite height");
  expect(setup.period_s >= 0.001 && setup.period_s <= 0.1, "period_s", setup.period_s, "0.001 to 0.1 s");
  return broken;
}

}  // namespace incise
