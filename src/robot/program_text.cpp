#include "robot/comment_text.hpp"
#include "robot/program_digest.hpp"
#include "robot/text_form.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using nlohmann::ordered_json;

ordered_json array_of(const Vec3& v) {
  return ordered_json::array({v.x(), v.y(), v.z()});
}

template <class Values>
std::string list_of(const Values& values) {
  std::string text;
  for (int i = 0; i < 6; ++i) text += fmt::format("{}{:.9f}", i > 0 ? ", " : "", values[i]);
  return text;
}

ordered_json json_of(const ProgramCheck& check) {
  ordered_json item{{"name", check.name},   {"passed", check.passed}, {"overridden", check.is_overridden},
                    {"value", check.value}, {"limit", check.limit},   {"relation", check.relation},
                    {"unit", check.unit}};
  item["pose"] = check.pose ? ordered_json(*check.pose) : ordered_json(nullptr);
  item["waypoint"] = check.waypoint ? ordered_json(*check.waypoint) : ordered_json(nullptr);
  item["text"] = check.text;
  return item;
}

ordered_json json_of(const JointMotion& motion) {
  ordered_json json;
  json["outcome"] = to_string(motion.outcome);
  if (motion.outcome != MotionOutcome::Found) {
    json["reason"] = motion.reason;
    return json;
  }
  json["branch"] = to_string(motion.branch);
  json["spin_deg"] = motion.spin_deg;
  json["period_s"] = motion.period_s;
  json["min_singular_value"] = motion.min_singular_value;
  json["min_joint_margin_deg"] = motion.min_joint_margin_deg;
  json["min_table_clearance_mm"] = motion.min_table_clearance_mm;
  json["joint_travel_deg"] = motion.travel_deg;
  json["columns"] = "time_s, six joints rad, six joint speeds rad/s";
  json["samples"] = ordered_json::array();
  for (const JointSample& sample : motion.samples) {
    ordered_json row = ordered_json::array({sample.time_s});
    for (int i = 0; i < 6; ++i) row.push_back(sample.q_rad[i]);
    for (int i = 0; i < 6; ++i) row.push_back(sample.speed_rad_s[i]);
    json["samples"].push_back(std::move(row));
  }
  return json;
}

}  // namespace

std::string to_joint_csv(const RobotProgram& program, const ProgramHeader& header) {
  robot_detail::require_finite(program);
  robot_detail::require_motion(program);
  std::string text = robot_detail::header_lines(header) + "time_s";
  for (const char* unit : {"_rad", "_rad_s", "_rad_s2"}) {
    for (const std::string& name : program.setup.arm.joint_names) text += "," + name + unit;
  }
  text += ",tip_x_mm,tip_y_mm,tip_z_mm,phase\n";
  for (const JointSample& s : program.motion.samples) {
    text += fmt::format("{:.6f}", s.time_s);
    for (int i = 0; i < 6; ++i) text += fmt::format(",{:.10f}", s.q_rad[i]);
    for (int i = 0; i < 6; ++i) text += fmt::format(",{:.8f}", s.speed_rad_s[i]);
    for (int i = 0; i < 6; ++i) text += fmt::format(",{:.6f}", s.acceleration_rad_s2[i]);
    const Vec3 tip =
        (forward_kinematics(program.setup.arm, s.q_rad) * program.setup.T_flange_tool).topRightCorner<3, 1>();
    const ProgramPhase phase = program.poses[std::min(s.pose + 1, program.poses.size() - 1)].phase;
    text += fmt::format(",{:.6f},{:.6f},{:.6f},{}\n", tip.x(), tip.y(), tip.z(), to_string(phase));
  }
  return robot_detail::sealed(std::move(text));
}

std::string to_ros_yaml(const RobotProgram& program, const ProgramHeader& header) {
  robot_detail::require_finite(program);
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

std::string to_json(const RobotProgram& program, const ProgramChecks* checks, const ProgramHeader& header) {
  robot_detail::require_finite(program);
  ordered_json document;
  document["schema"] = "incise.program/1";
  document["frame"] = "robot";
  if (!header.empty()) {
    document["header"] = ordered_json::array();
    for (const auto& [key, value] : robot_detail::plain_header(robot_detail::with_digest_entry(header)))
      document["header"].push_back({key, value});
  }
  document["kind"] = to_string(program.kind);
  document["closed"] = program.is_closed;
  document["duration_s"] = program.duration_s();
  document["cut_length_mm"] = program.cut_length_mm;
  document["overlap_mm"] = program.overlap_mm;
  document["spacing_mm"] = program.spacing_mm;
  document["chord_error_mm"] = program.chord_error_mm;
  document["poses"] = ordered_json::array();
  for (const ProgramPose& pose : program.poses) {
    document["poses"].push_back({{"phase", to_string(pose.phase)},
                                 {"time_s", pose.time_s},
                                 {"tip_mm", array_of(pose.tip_mm)},
                                 {"rotation_vector", array_of(pose.rotation_vector)},
                                 {"tip_speed_mm_s", pose.tip_speed_mm_s},
                                 {"depth_mm", pose.depth_mm},
                                 {"waypoint", pose.waypoint}});
  }
  document["motion"] = json_of(program.motion);
  if (checks != nullptr) {
    document["checks"] = ordered_json::array();
    for (const ProgramCheck& check : checks->checks) document["checks"].push_back(json_of(check));
    document["checks_not_made"] = checks->not_made;
  }
  return robot_detail::sealed(document.dump(2) + "\n");
}

}  // namespace incise
