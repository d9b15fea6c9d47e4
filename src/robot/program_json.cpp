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

/// Not in the unnamed namespace, where argument-dependent lookup would not find it.
static void describe(Visitor& v, ProgramPose& p) {
  v("phase", p.phase, "Phase of the program.");
  v({"time_s", "Time from the start of the program.", "s"}, p.time_s);
  v({"tip_mm", "Position of the tool's tip.", "mm"}, p.tip_mm);
  v({"rotation_vector", "Orientation of the tool.", "rad"}, p.rotation_vector);
  v({"tip_speed_mm_s", "Speed of the tip in the move that ends at this pose.", "mm/s"}, p.tip_speed_mm_s);
  v({"depth_mm", "Depth of the tip below the surface; negative above it.", "mm"}, p.depth_mm);
  v.derived("waypoint", p.waypoint, "Index of the path's waypoint at or before this pose.");
}

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
  v("name", c.name, "Name of the check.");
  v("passed", c.passed, "Whether the program passes the check.");
  v.derived("overridden", c.is_overridden, "Whether a person has taken responsibility for the failed check.");
  describe_limit(v, {"value", "Value that was found."}, c.value);
  describe_limit(v, {"limit", "Limit of the value."}, c.limit);
  v("relation", c.relation, "Relation that the value must have to the limit; empty: a yes or no.");
  v("unit", c.unit, "Unit of the value and the limit.");
  v.derived("pose", c.pose, "Index of the worst pose of the program.");
  v.derived("waypoint", c.waypoint, "Index of the path's waypoint at or before that pose.");
  v.derived("text", c.text, "Meaning of the check, for a person.");
}

/// Time (s), six joints (rad) and their speeds (rad/s).
using MotionRow = std::array<double, 13>;
struct MotionEntry {
  JointMotion motion;
  std::vector<MotionRow> rows;
};
void describe(Visitor& v, MotionEntry& entry) {
  const JointMotion& m = entry.motion;
  v.derived("outcome", m.outcome, "Whether the arm can follow the program.");
  if (!v.sets() && m.outcome != MotionOutcome::Found)
    return v.derived("reason", m.reason, "Why the arm cannot follow the program.");
  v.derived("branch", std::string(to_string(m.branch)), "Branch of the inverse kinematics.");
  v.derived("spin_deg", m.spin_deg, "Spin of the tool about its axis.");
  v.derived("period_s", m.period_s, "Time between two samples.");
  v.derived("min_singular_value", m.min_singular_value, "Smallest singular value of the arm's Jacobian.");
  v.derived("min_joint_margin_deg", m.min_joint_margin_deg, "Least distance of a joint from its limits.");
  v.derived("min_table_clearance_mm", m.min_table_clearance_mm, "Least height of the links' hulls above the table.");
  v.derived("joint_travel_deg", m.travel_deg, "Sum of the travel of all joints.");
  v.derived("columns", std::string("time_s, six joints rad, six joint speeds rad/s"), "Columns of the samples.");
  v("samples", entry.rows, "Samples of the joints, one row for each time.");
}

struct ProgramFile {
  std::vector<std::array<std::string, 2>> header;
  RobotProgram program;
  MotionEntry motion;
  std::optional<std::vector<ProgramCheckEntry>> checks;
  std::optional<std::vector<std::string>> not_made;
};
void describe(Visitor& v, ProgramFile& file) {
  RobotProgram& p = file.program;
  constant(v, {"schema", "Format and version of this file."}, kSchema);
  v.derived("frame", PathFrame::Robot, "Frame of the poses.");
  const Field header{.name = "header", .meaning = "Keys and values of the header, as in a script.", .is_omitted = true};
  if (v.sets() || v.optional(header, !file.header.empty())) v(header, file.header);
  v.derived("kind", p.kind, "What the tool does along the path.");
  v.derived("closed", p.is_closed, "Whether the path is a ring.");
  v.derived("duration_s", p.duration_s(), "Duration of the whole program.");
  v.derived("cut_length_mm", p.cut_length_mm, "Length of the path, without overlap.");
  v.derived("overlap_mm", p.overlap_mm, "Distance that a closed path is cut beyond its start.");
  v.derived("spacing_mm", p.spacing_mm, "Spacing of the poses along the cut.");
  v.derived("chord_error_mm", p.chord_error_mm, "Greatest deviation of the moves from the smooth course.");
  v("poses", p.poses, "Poses in the order of the program.");
  v("motion", file.motion, "Motion of the arm's joints.");
  v({.name = "checks", .meaning = "Checks that were made of the program.", .is_omitted = true}, file.checks);
  v({.name = "checks_not_made", .meaning = "Checks that were not made, and why.", .is_omitted = true}, file.not_made);
}

}  // namespace

std::string program_json(const RobotProgram& program, const ProgramChecks* checks, const ProgramHeader& header) {
  robot_detail::require_finite(program);
  ProgramFile file{.program = program, .motion = {program.motion, {}}};
  if (!header.empty()) {
    for (const auto& [key, value] : robot_detail::plain_header(robot_detail::with_digest_entry(header)))
      file.header.push_back({key, value});
  }
  for (const JointSample& sample : program.motion.samples) {
    MotionRow& row = file.motion.rows.emplace_back();
    row[0] = sample.time_s;
    Joints::Map(&row[1]) = sample.q_rad;
    Joints::Map(&row[7]) = sample.speed_rad_s;
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
  if (file.program.poses.empty()) throw DataError(name, "/poses", "0 entries", "a list of 1 or more", kHint);
  program.listed_poses = file.program.poses;
  if (file.checks) {
    for (const ProgramCheckEntry& entry : *file.checks)
      program.listed_checks.push_back(held_against_its_limit(entry.check));
  }
  std::size_t next = 0;
  for (std::size_t k = 0; k < file.motion.rows.size(); ++k) {
    const MotionRow& row = file.motion.rows[k];
    TimedJoints joints{.time_s = row[0], .q_rad = Joints::Map(&row[1]), .speed_rad_s = Joints::Map(&row[7])};
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
