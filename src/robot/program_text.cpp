#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/program_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace incise {
namespace {

using nlohmann::ordered_json;

void require_finite(const RobotProgram& program) {
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPose& p = program.poses[i];
    INCISE_REQUIRE(p.tip_mm.allFinite() && p.rotation_vector.allFinite() && std::isfinite(p.time_s) &&
                       std::isfinite(p.tip_speed_mm_s) && std::isfinite(p.depth_mm),
                   fmt::format("expected finite numbers, found others at pose {}", i));
  }
}

bool is_identifier(const std::string& name) {
  const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  return !name.empty() && letters.find(name[0]) != std::string::npos &&
         name.find_first_not_of(letters + "0123456789") == std::string::npos;
}

void require_valid(const UrScriptSettings& s) {
  INCISE_REQUIRE(is_identifier(s.function_name),
                 fmt::format("expected a function name of letters, digits and _, found '{}'", s.function_name));
  INCISE_REQUIRE(s.blend_fraction >= 0.0 && s.blend_fraction < 0.5,
                 fmt::format("expected a blend fraction in [0, 0.5), found {}", s.blend_fraction));
  if (s.T_flange_tool) {
    const Mat3 rotation = s.T_flange_tool->topLeftCorner<3, 3>();
    const bool is_rigid = s.T_flange_tool->allFinite() &&
                          (rotation * rotation.transpose() - Mat3::Identity()).norm() < 1e-6 &&
                          rotation.determinant() > 0.0;
    INCISE_REQUIRE(is_rigid, "expected a rigid transform T_flange_tool");
  }
}

/// p[x, y, z, rx, ry, rz] in m and rad; 10 nm and 1 µrad are far below what an arm resolves.
std::string pose_text(const Vec3& position_mm, const Vec3& rotation_vector) {
  const Vec3 p(units::m_from_mm(position_mm.x()), units::m_from_mm(position_mm.y()), units::m_from_mm(position_mm.z()));
  return fmt::format("p[{:.8f}, {:.8f}, {:.8f}, {:.6f}, {:.6f}, {:.6f}]", p.x(), p.y(), p.z(), rotation_vector.x(),
                     rotation_vector.y(), rotation_vector.z());
}

std::string heading(const RobotProgram& program, const UrScriptSettings& settings) {
  std::string text =
      "# Tool path planned by simulation (incise). Virtual: it has not been run on an arm.\n"
      "# Units: m, s, rad, m/s, m/s^2. Poses p[x, y, z, rx, ry, rz] of the tool's tip in the base frame, rotation as "
      "axis times angle.\n"
      "# Not checked: reachability, singularities, joint limits and speeds, collisions, accelerations. The electrode "
      "is not switched.\n";
  for (const std::string& item : settings.provenance) {
    std::istringstream lines(item);
    for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  }
  text += fmt::format("# {} poses, {:.2f} s, {:.2f} mm of cut, {:.2f} mm of overlap\n", program.poses.size(),
                      program.duration_s(), program.cut_length_mm, program.overlap_mm);
  return text;
}

std::string tcp_line(const UrScriptSettings& settings) {
  if (!settings.T_flange_tool) return "  # The tool's tip has to be the active TCP of the controller.\n";
  const Eigen::AngleAxisd turn(Mat3(settings.T_flange_tool->topLeftCorner<3, 3>()));
  return fmt::format("  set_tcp({})\n",
                     pose_text(settings.T_flange_tool->topRightCorner<3, 1>(), turn.angle() * turn.axis()));
}

bool is_cut(const ProgramPose& pose) {
  return pose.phase == ProgramPhase::Cut || pose.phase == ProgramPhase::Overlap;
}

/// Blend radius at pose i, m: none where the course stops.
double blend_m(const RobotProgram& program, std::size_t i, double fraction) {
  if (i + 1 >= program.poses.size() || !is_cut(program.poses[i + 1])) return 0.0;
  const double before = (program.poses[i].tip_mm - program.poses[i - 1].tip_mm).norm();
  const double after = (program.poses[i + 1].tip_mm - program.poses[i].tip_mm).norm();
  return units::m_from_mm(fraction * std::min(before, after));
}

ordered_json array_of(const Vec3& v) {
  return ordered_json::array({v.x(), v.y(), v.z()});
}

}  // namespace

std::string to_urscript(const RobotProgram& program, const UrScriptSettings& settings) {
  require_finite(program);
  require_valid(settings);
  std::string text = heading(program, settings);
  text += fmt::format("def {}():\n", settings.function_name) + tcp_line(settings);
  const double a = units::m_from_mm(program.settings.acceleration_mm_s2);
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPose& pose = program.poses[i];
    if (i == 0 || pose.phase != program.poses[i - 1].phase) text += fmt::format("  # {}\n", to_string(pose.phase));
    const std::string place = pose_text(pose.tip_mm, pose.rotation_vector);
    // The way to the first pose is not ours: it begins wherever the arm stands, at the speed of the approach.
    const double speed_mm_s =
        i == 0 && program.poses.size() > 1 ? program.poses[1].tip_speed_mm_s : pose.tip_speed_mm_s;
    const double v = units::m_from_mm(speed_mm_s);
    if (pose.phase == ProgramPhase::Dwell) {
      text += fmt::format("  sleep({:.3f})\n", pose.time_s - program.poses[i - 1].time_s);
    } else if (is_cut(pose)) {
      text += fmt::format("  movep({}, a={:.4f}, v={:.6f}, r={:.6f})\n", place, a, v,
                          blend_m(program, i, settings.blend_fraction));
    } else {
      text += fmt::format("  movel({}, a={:.4f}, v={:.6f})\n", place, a, v);
    }
  }
  return text + fmt::format("end\n\n{}()\n", settings.function_name);
}

std::string to_json(const RobotProgram& program, const ProgramChecks* checks) {
  require_finite(program);
  ordered_json document;
  document["schema"] = "incise.program/1";
  document["frame"] = "robot";
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
                                 {"depth_mm", pose.depth_mm}});
  }
  if (checks != nullptr) {
    document["checks"] = ordered_json::array();
    for (const ProgramCheck& check : checks->checks) {
      ordered_json item{{"name", check.name},   {"passed", check.passed},     {"value", check.value},
                        {"limit", check.limit}, {"relation", check.relation}, {"unit", check.unit}};
      item["pose"] = check.pose ? ordered_json(*check.pose) : ordered_json(nullptr);
      item["text"] = check.text;
      document["checks"].push_back(std::move(item));
    }
    document["checks_not_made"] = checks->not_made;
  }
  return document.dump(2) + "\n";
}

}  // namespace incise
