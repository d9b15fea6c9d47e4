#pragma once

#include <incise/robot/checks.hpp>
#include <incise/robot/program.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// How a program is written as URScript.
struct UrScriptSettings {
  std::string function_name = "incise_cut";  ///< letters, digits and _, not starting with a digit
  double blend_fraction = 0.4;  ///< blend radius of the cut's poses, as a fraction of their spacing; in [0, 0.5)
  std::vector<std::string> provenance{};  ///< lines for the heading: what it was made from, hashes, version
  std::optional<Mat4>
      T_flange_tool{};  ///< mm, a rigid transform; written as set_tcp. Without it the controller's own TCP holds
};

/// The program as a URScript function and a call to it: metres, seconds, axis-angle poses p[x, y, z, rx, ry, rz] of the
/// tool's tip in the base frame; `movel` through the air, into and out of the tissue, `movep` with blends along the
/// cut, so that the tip keeps its speed. The power of the electrode is not switched. Nothing in it opens a connection.
/// A comment says that it comes from a simulation.
/// @pre the program's numbers are finite, the settings are valid (InvalidArgument).
[[nodiscard]] std::string to_urscript(const RobotProgram& program, const UrScriptSettings& settings = {});

/// The program as JSON, mm, s and rad: `poses` with `phase`, `time_s`, `tip_mm`, `rotation_vector`, `tip_speed_mm_s`,
/// `depth_mm`; with `checks` given, also every check (name, passed, value, limit, unit, pose, text) and
/// `checks_not_made`.
/// @pre the program's numbers are finite (InvalidArgument).
[[nodiscard]] std::string to_json(const RobotProgram& program, const ProgramChecks* checks = nullptr);

}  // namespace incise
