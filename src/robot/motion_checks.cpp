#include "robot/check_list.hpp"
#include "robot/surface_probe.hpp"
#include "robot/text_form.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

/// Time that the tip needs to reach the greatest speed of the cut, and a little more.
double ramp_s(const RobotProgram& program) {
  constexpr double kMoreS = 0.02;
  double speed = 0.0;
  for (const ProgramPose& pose : program.poses) {
    if (is_cut(pose.phase)) speed = std::max(speed, pose.tip_speed_mm_s);
  }
  const double a = program.settings.acceleration_mm_s2, j = program.settings.jerk_mm_s3;
  return kMoreS + (speed > a * a / j ? speed / a + a / j : 2.0 * std::sqrt(speed / j));
}

/// Times at which the cut begins or ends, or its nominal speed changes.
std::vector<double> changes_s(const RobotProgram& program) {
  std::vector<double> times;
  for (std::size_t i = 1; i < program.poses.size(); ++i) {
    const ProgramPose &before = program.poses[i - 1], &pose = program.poses[i];
    if (is_cut(before.phase) != is_cut(pose.phase) || before.tip_speed_mm_s != pose.tip_speed_mm_s)
      times.push_back(before.time_s);
  }
  return times;
}

void check_tip_speed(CheckList& list, const CheckSettings& settings) {
  const RobotProgram& program = list.program();
  const auto& samples = program.motion.samples;
  const auto tip = [&](std::size_t i) { return tip_at(program.setup, samples[i].q_rad); };
  const std::vector<double> changes = changes_s(program);
  const double ramp = ramp_s(program);
  const auto is_near_a_change = [&](double time_s) {
    return std::any_of(changes.begin(), changes.end(), [&](double at) { return std::abs(at - time_s) < ramp; });
  };
  Worst worst;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].pose + 1 >= program.poses.size()) continue;
    const ProgramPose& next = program.poses[samples[i].pose + 1];
    if (!is_cut(next.phase) || is_near_a_change(samples[i].time_s)) continue;
    const double speed = (tip(i) - tip(i - 1)).norm() / program.motion.period_s;
    worst.see(std::abs(speed / next.tip_speed_mm_s - 1.0), samples[i].pose);
  }
  if (worst.pose) {
    list.at_most("tip_speed", worst.value, settings.tip_speed_tolerance, "", worst.pose,
                 "greatest deviation of the tip's speed from the nominal one, as a share, away from ends and changes");
  } else {
    list.not_made("tip_speed: the cut is shorter than its ramps");
  }
}

}  // namespace

void check_motion(CheckList& list, const CheckSettings& settings) {
  const RobotProgram& program = list.program();
  const JointMotion& motion = program.motion;
  if (motion.outcome != MotionOutcome::Found) {
    list.holds(
        "reach", false,
        motion.outcome == MotionOutcome::Unreachable
            ? fmt::format("the arm cannot reach this pose on any branch with any turn of the tool about its axis ({})",
                          motion.reason)
            : "the arm's joints would jump: " + motion.reason,
        motion.failed_pose);
    list.not_made(
        "joint limits, speeds, accelerations, singularities, tip speed and table: no motion of the arm was found");
    return;
  }
  list.holds("reach", true, fmt::format("every pose is reached on one branch: {}", to_string(motion.branch)));
  const ArmModel& arm = program.setup.arm;
  Worst margin, speed, acceleration, singular, table;
  for (const JointSample& s : motion.samples) {
    margin.see(-std::min((s.q_rad - arm.min_rad).minCoeff(), (arm.max_rad - s.q_rad).minCoeff()), s.pose);
    speed.see((s.speed_rad_s.cwiseAbs().cwiseQuotient(arm.max_speed_rad_s)).maxCoeff(), s.pose);
    acceleration.see(s.acceleration_rad_s2.cwiseAbs().maxCoeff(), s.pose);
    singular.see(-smallest_singular_value(arm, s.q_rad), s.pose);
    table.see(-table_clearance_mm(arm, s.q_rad, program.setup.table_z_mm), s.pose);
  }
  list.at_least("joint_limits", units::deg_from_rad(-margin.value), settings.joint_margin_deg, "deg", margin.pose,
                "least distance of a joint from its limits");
  list.at_most("joint_speed", speed.value, settings.joint_speed_share, "", speed.pose,
               "greatest joint speed as a share of the maker's limit");
  list.at_most("joint_acceleration", acceleration.value, settings.max_joint_acceleration_rad_s2, "rad/s2",
               acceleration.pose, "greatest joint acceleration");
  list.at_least("singularity", -singular.value, settings.min_singular_value, "", singular.pose,
                "smallest singular value of the Jacobian (lengths over 600 mm)");
  check_tip_speed(list, settings);
  list.at_least("table", -table.value, settings.table_clearance_mm, "mm", table.pose,
                fmt::format("least height of the arm's links above the table at z = {} mm", program.setup.table_z_mm));
}

void check_depth_in(CheckList& list, const TriMesh& surface, double depth_mm, double tolerance_mm) {
  const SurfaceProbe probe(surface);
  const RobotProgram& program = list.program();
  Worst worst;
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPose& pose = program.poses[i];
    if (pose.phase != ProgramPhase::Plunge && !is_cut(pose.phase)) continue;
    const auto depth = probe.depth_mm(pose.tip_mm, pose.R_robot_tool.col(2));
    if (!depth) {
      list.holds("depth", false, "the surface has a gap below the tool: the tool's depth is not known there", i);
      return;
    }
    worst.see(std::abs(*depth - depth_mm), i);
  }
  list.at_most(
      "depth", worst.value, tolerance_mm, "mm", worst.pose,
      fmt::format("greatest difference from the planned depth of {} mm, measured below the surface", depth_mm));
}

}  // namespace incise::robot_detail
