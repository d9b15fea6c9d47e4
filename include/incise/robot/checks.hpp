#pragma once

#include <incise/robot/program.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Limits that a program is held to before it may be written for a robot.
struct CheckSettings {
  bool must_be_ring = true;     ///< the plan is a ring (plan.kind: ring), so the path has to be closed
  double min_speed_mm_s = 0.5;  ///< of the tip in the tissue
  double max_speed_mm_s = 30.0;
  double planned_depth_mm = 5.0;
  double depth_tolerance_mm = 0.5;
  double close_margin_mm = 2.2;   ///< least distance of the path from the tumour edge, on its outside
  double max_deviation_mm = 4.0;  ///< of the path from the intended one: more than any correction should ask for
  double max_reach_mm = 1300.0;   ///< UR10e: from the base axis to the wrist (Universal Robots' data sheet)
  double tool_length_mm = 150.0;  ///< from the flange to the tip, along the axis
};

/// One named check: passed when `value` keeps to `limit` as `relation` says, or, without a relation, when `text` is
/// true.
struct ProgramCheck {
  std::string name;
  bool passed = false;
  double value = 0.0;
  double limit = 0.0;
  std::string relation = "<=";      ///< "<=", ">=", or empty for a plain yes or no
  std::string unit;                 ///< mm, mm/s or empty
  std::optional<std::size_t> pose;  ///< the worst pose of the program, where there is one
  std::string text;                 ///< for a person
};

struct ProgramChecks {
  std::vector<ProgramCheck> checks;
  std::vector<std::string> not_made;  ///< what nobody has looked at: read it before a robot moves
  [[nodiscard]] bool all_passed() const;
};

/// Checks a program and the path that it came from. Names of the checks, in this order:
///
///   finite           every number of the program is finite; if not, no other check is made
///   frame            the path is given in the robot's base frame
///   closed           (rings) the path is closed and the cut ends where it began, to 0.01 mm
///   self_crossing    the entry course crosses itself nowhere, seen along the mean axis
///   speed_min, speed_max   tip speed while cutting
///   depth            every waypoint's depth is the planned one within the tolerance
///   margin           the entry course stays outside the tumour edge by `close_margin_mm` (distances to the edge's
///   segments) deviation        no entry point farther than `max_deviation_mm` from the intended path (if given) reach
///   the flange stays within `max_reach_mm` of the base's origin
///
/// This is geometry only. Inverse kinematics, singularities, joint limits and speeds, collisions, accelerations and
/// forces are **not** checked; `not_made` lists them, together with checks that lack their input (no tumour edge, no
/// intended path).
/// @param intended  the path before correction, same frame; nullptr if there is none.
[[nodiscard]] ProgramChecks check_program(const RobotProgram& program, const ToolPath& path,
                                          const CheckSettings& settings = {}, const ToolPath* intended = nullptr);

}  // namespace incise
