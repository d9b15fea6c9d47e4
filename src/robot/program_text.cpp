#include "robot/comment_text.hpp"
#include "robot/program_digest.hpp"
#include "robot/text_form.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

template <class Values>
std::string list_of(const Values& values) {
  std::string text;
  for (int i = 0; i < 6; ++i) text += fmt::format("{}{:.9f}", i > 0 ? ", " : "", values[i]);
  return text;
}

}  // namespace

std::string robot_detail::joint_csv_columns(const ArmModel& arm) {
  std::string columns = "time_s";
  for (const char* unit : {"_rad", "_rad_s", "_rad_s2"}) {
    for (const std::string& name : arm.joint_names) columns += "," + name + unit;
  }
  return columns + ",tip_x_mm,tip_y_mm,tip_z_mm,phase";
}

std::string to_joint_csv(const RobotProgram& program, const ProgramHeader& header) {
  robot_detail::require_motion(program);
  std::string text = robot_detail::header_lines(header) + robot_detail::joint_csv_columns(program.setup.arm) + "\n";
  for (const JointSample& s : program.motion.samples) {
    text += fmt::format("{:.6f}", s.time_s);
    for (int i = 0; i < 6; ++i) text += fmt::format(",{:.10f}", s.q_rad[i]);
    for (int i = 0; i < 6; ++i) text += fmt::format(",{:.8f}", s.speed_rad_s[i]);
    for (int i = 0; i < 6; ++i) text += fmt::format(",{:.6f}", s.acceleration_rad_s2[i]);
    const Vec3 tip = robot_detail::tip_at(program.setup, s.q_rad);
    const ProgramPhase phase = program.poses[std::min(s.pose + 1, program.poses.size() - 1)].phase;
    text += fmt::format(",{:.6f},{:.6f},{:.6f},{}\n", tip.x(), tip.y(), tip.z(), to_string(phase));
  }
  return robot_detail::sealed(std::move(text));
}

std::string to_ros_yaml(const RobotProgram& program, const ProgramHeader& header) {
  robot_detail::require_motion(program);
  std::string text = robot_detail::header_lines(header);
  text += "header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: base\njoint_names:\n";
  for (const std::string& name : program.setup.arm.joint_names) text += fmt::format("- {}\n", name);
  text += "points:\n";
  for (const JointSample& s : program.motion.samples) {
    const auto ns = static_cast<long long>(std::llround(s.time_s * 1e9));
    text += fmt::format(
        "- positions: [{}]\n  velocities: [{}]\n  accelerations: [{}]\n  effort: []\n"
        "  time_from_start: {{sec: {}, nanosec: {}}}\n",
        list_of(s.q_rad), list_of(s.speed_rad_s), list_of(s.acceleration_rad_s2), ns / 1000000000, ns % 1000000000);
  }
  return robot_detail::sealed(std::move(text));
}

}  // namespace incise
