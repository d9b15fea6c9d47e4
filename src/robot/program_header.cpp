#include "robot/comment_text.hpp"
#include "robot/program_digest.hpp"
#include "robot/program_record.hpp"
#include "robot/text_form.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/program_reading.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace robot_detail {

void require_finite(const RobotProgram& program) {
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPose& p = program.poses[i];
    INCISE_REQUIRE(p.tip_mm.allFinite() && p.rotation_vector.allFinite() && std::isfinite(p.time_s) &&
                       std::isfinite(p.tip_speed_mm_s) && std::isfinite(p.depth_mm),
                   fmt::format("expected finite numbers, found others at pose {}", i));
  }
}

void require_motion(const RobotProgram& program) {
  require_finite(program);
  INCISE_REQUIRE(
      program.motion.outcome == MotionOutcome::Found && !program.motion.samples.empty(),
      fmt::format("expected a program that the arm can follow, found {}", to_string(program.motion.outcome)));
}

std::string header_lines(const ProgramHeader& header) {
  std::string text;
  for (const auto& [key, value] : plain_header(with_digest_entry(header)))
    text += fmt::format("{}{}: {}\n", kHeaderMark, key, value);
  return text;
}

std::string held_against_its_limit(const ProgramCheck& check) {
  const std::string verdict = fmt::format("{} {}", check.name, check.passed ? "passed" : "FAILED");
  if (check.relation.empty()) return verdict;
  const std::string unit = check.unit.empty() ? "" : " " + check.unit;
  return fmt::format("{}: {:.4g}{} {} {:.4g}{}", verdict, check.value, unit, check.relation, check.limit, unit);
}

}  // namespace robot_detail

ProgramHeader program_header(const RobotProgram& program, const ToolPath& path, const ProgramChecks& checks,
                             const ProgramHeader& provenance) {
  ProgramHeader header{{"format", "incise.program/1"},
                       {"note", "Planned by simulation. Virtual: it has not been run on an arm."}};
  header.insert(header.end(), provenance.begin(), provenance.end());
  const auto add = [&header](const char* key, std::string value) { header.emplace_back(key, std::move(value)); };
  add("kind", std::string(to_string(program.kind)));
  add("closed", program.is_closed ? "true" : "false");
  add("cut_length_mm", fmt::format("{:.6f}", program.cut_length_mm));
  add("overlap_mm", fmt::format("{}", program.overlap_mm));
  add("duration_s", fmt::format("{:.3f}", program.duration_s()));
  add("approach_height_mm", fmt::format("{}", program.settings.approach_height_mm));
  add("clearance_mm", fmt::format("{}", program.settings.clearance_mm));
  add("robot", program.setup.arm.name);
  std::string tool;
  for (int i = 0; i < 16; ++i)
    tool += fmt::format("{}{:.12g}", i > 0 ? " " : "", program.setup.T_flange_tool(i / 4, i % 4));
  add("T_flange_tool", tool);
  add("branch", to_string(program.motion.branch));
  add("spin_deg", fmt::format("{}", program.motion.spin_deg));
  const ProgramRecord record{program.settings, program.setup, checks.settings};
  robot_detail::describe(record, [&add](const char* key, const char* name, const auto& number) {
    add(key, fmt::format("{} {}", name, static_cast<double>(number)));
  });
  for (const Waypoint& w : path.waypoints) {
    add("waypoint",
        fmt::format("{:.6f} {:.6f} {:.6f} {:.8f} {:.8f} {:.8f} {:.6f} {:.6f}", w.position_mm.x(), w.position_mm.y(),
                    w.position_mm.z(), w.axis.x(), w.axis.y(), w.axis.z(), w.depth_mm, w.speed_mm_s));
  }
  add("tumor_edge_closed", path.tumor_edge.is_closed ? "true" : "false");
  for (const Vec3& point : path.tumor_edge.points)
    add("tumor_edge", fmt::format("{:.6f} {:.6f} {:.6f}", point.x(), point.y(), point.z()));
  for (const ProgramCheck& check : checks.checks) {
    if (check.is_overridden)
      add("override", check.message());
    else
      add("check", robot_detail::held_against_its_limit(check));
  }
  for (const std::string& what : checks.not_made) add("not_checked", what);
  return header;
}

}  // namespace incise
