#include "robot/comment_text.hpp"
#include "robot/program_digest.hpp"
#include "robot/program_reading.hpp"
#include "robot/program_record.hpp"
#include "robot/text_form.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/json_text.hpp>

#include <fmt/format.h>

#include <limits>

namespace incise {
namespace {

constexpr std::string_view kSchema = "incise.program/1";
constexpr const char* kHint = "`incise export --format json` writes them";

/// A check in a file. JSON has no infinity, so an infinite value or limit is null.
struct ProgramCheckEntry {
  ProgramCheck check;
};
void describe_limit(Visitor& v, const Field& field, double& value) {
  std::optional<double> known = if_finite(value);
  v(field, known);
  value = known.value_or(std::numeric_limits<double>::infinity());
}
void describe(Visitor& v, ProgramCheckEntry& entry) {
  ProgramCheck& c = entry.check;
  v("name", c.name, "Of the check.");
  v("passed", c.passed, "Whether the program keeps to it.");
  v.derived("overridden", c.is_overridden, "Whether a person has taken it on them.");
  describe_limit(v, {"value", "What was found."}, c.value);
  describe_limit(v, {"limit", "What is allowed."}, c.limit);
  v("relation", c.relation, "Between the two; empty: a plain yes or no.");
  v("unit", c.unit, "Of both.");
  v.derived("pose", c.pose, "The worst one.");
  v.derived("waypoint", c.waypoint, "Of the path, at or before that pose.");
  v.derived("text", c.text, "For a person.");
}

struct PoseEntry {
  ProgramPose pose;
};
void describe(Visitor& v, PoseEntry& entry) {
  ProgramPose& p = entry.pose;
  v("phase", p.phase, "Of the program.");
  v({"time_s", "From the start.", "s"}, p.time_s);
  v({"tip_mm", "Of the tool.", "mm"}, p.tip_mm);
  v({"rotation_vector", "Of the tool.", "rad"}, p.rotation_vector);
  v({"tip_speed_mm_s", "Of the move that ends here.", "mm/s"}, p.tip_speed_mm_s);
  v({"depth_mm", "Of the tip below the surface; negative above it.", "mm"}, p.depth_mm);
  v.derived("waypoint", p.waypoint, "Of the path, at or before this pose.");
}

/// Time (s), six joints (rad) and their speeds (rad/s).
using MotionRow = std::array<double, 13>;
struct MotionEntry {
  JointMotion motion;
  std::vector<MotionRow> rows;
};
void describe(Visitor& v, MotionEntry& entry) {
  const JointMotion& m = entry.motion;
  v.derived("outcome", m.outcome, "Whether the arm can follow.");
  if (!v.sets() && m.outcome != MotionOutcome::Found) return v.derived("reason", m.reason, "Why it cannot.");
  v.derived("branch", std::string(to_string(m.branch)), "Of the inverse kinematics.");
  v.derived("spin_deg", m.spin_deg, "Of the tool about its axis.");
  v.derived("period_s", m.period_s, "Between two samples.");
  v.derived("min_singular_value", m.min_singular_value, "Of the arm's Jacobian.");
  v.derived("min_joint_margin_deg", m.min_joint_margin_deg, "From the joints' limits.");
  v.derived("min_table_clearance_mm", m.min_table_clearance_mm, "Of the links' hulls.");
  v.derived("joint_travel_deg", m.travel_deg, "Sum of the ways of all joints.");
  v.derived("columns", std::string("time_s, six joints rad, six joint speeds rad/s"), "Of the samples.");
  v("samples", entry.rows, "One row at a time.");
}

struct ProgramFile {
  std::vector<std::array<std::string, 2>> header;
  RobotProgram program;
  std::vector<PoseEntry> poses;
  MotionEntry motion;
  std::optional<std::vector<ProgramCheckEntry>> checks;
  std::optional<std::vector<std::string>> not_made;
};
void describe(Visitor& v, ProgramFile& file) {
  const RobotProgram& p = file.program;
  constant(v, {"schema", "Format and version of this file."}, kSchema);
  v.derived("frame", PathFrame::Robot, "Whose coordinates poses have.");
  const Field header{.name = "header", .meaning = "Key and value, as in a script.", .is_omitted = true};
  if (v.sets() || v.optional(header, !file.header.empty())) v(header, file.header);
  v.derived("kind", p.kind, "What the tool does along the path.");
  v.derived("closed", p.is_closed, "Whether the path is a ring.");
  v.derived("duration_s", p.duration_s(), "Of all.");
  v.derived("cut_length_mm", p.cut_length_mm, "Once along the path.");
  v.derived("overlap_mm", p.overlap_mm, "Beyond the start of a closed path.");
  v.derived("spacing_mm", p.spacing_mm, "Of the poses along the cut.");
  v.derived("chord_error_mm", p.chord_error_mm, "Of the moves from the smooth course.");
  v("poses", file.poses, "In order.");
  v("motion", file.motion, "Of the arm's joints.");
  v({.name = "checks", .meaning = "What the program was held against.", .is_omitted = true}, file.checks);
  v({.name = "checks_not_made", .meaning = "For want of what.", .is_omitted = true}, file.not_made);
}

}  // namespace

std::string program_json(const RobotProgram& program, const ProgramChecks* checks, const ProgramHeader& header) {
  robot_detail::require_finite(program);
  ProgramFile file{.program = program, .motion = {program.motion, {}}};
  if (!header.empty()) {
    for (const auto& [key, value] : robot_detail::plain_header(robot_detail::with_digest_entry(header)))
      file.header.push_back({key, value});
  }
  for (const ProgramPose& pose : program.poses) file.poses.push_back({pose});
  for (const JointSample& sample : program.motion.samples) {
    MotionRow& row = file.motion.rows.emplace_back();
    row[0] = sample.time_s;
    for (std::size_t i = 0; i < 6; ++i) {
      row[1 + i] = sample.q_rad[static_cast<int>(i)];
      row[7 + i] = sample.speed_rad_s[static_cast<int>(i)];
    }
  }
  if (checks != nullptr) {
    file.checks.emplace();
    for (const ProgramCheck& check : checks->checks) file.checks->push_back({check});
    file.not_made = checks->not_made;
  }
  return robot_detail::sealed(to_json(file).dump(2) + "\n");
}

WrittenProgram robot_detail::read_program_json(std::string_view text, const std::filesystem::path& name) {
  const auto file = from_json<ProgramFile>(parse_json(text, name), name, {}, kHint);
  WrittenProgram program;
  for (const auto& [key, value] : file.header) program.header.emplace_back(key, value);
  if (file.poses.empty()) throw DataError(name, "/poses", "0 entries", "a list of 1 or more", kHint);
  for (const PoseEntry& entry : file.poses) program.listed_poses.push_back(entry.pose);
  if (file.checks) {
    for (const ProgramCheckEntry& entry : *file.checks)
      program.listed_checks.push_back(held_against_its_limit(entry.check));
  }
  std::size_t next = 0;
  for (std::size_t k = 0; k < file.motion.rows.size(); ++k) {
    const MotionRow& row = file.motion.rows[k];
    TimedJoints joints{.time_s = row[0]};
    for (std::size_t i = 0; i < 6; ++i) {
      joints.q_rad[static_cast<int>(i)] = row[1 + i];
      joints.speed_rad_s[static_cast<int>(i)] = row[7 + i];
    }
    while (next + 1 < program.listed_poses.size() && program.listed_poses[next].time_s <= joints.time_s) ++next;
    joints.phase = program.listed_poses[next].phase;
    add_row(program, joints, [&](const std::string& found, const std::string& expected) {
      throw DataError(name, fmt::format("/motion/samples/{}", k), found, expected);
    });
  }
  if (program.joints.size() < 2)
    throw DataError(name, "/motion/samples", fmt::format("{} samples", program.joints.size()), "at least 2");
  return program;
}

}  // namespace incise
