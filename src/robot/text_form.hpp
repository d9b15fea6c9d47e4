#pragma once

#include <incise/robot/program_text.hpp>

#include <string>

namespace incise::robot_detail {

/// Returns the place of the tool's tip, base frame, mm.
[[nodiscard]] inline Vec3 tip_at(const ArmSetup& setup, const Joints& q) {
  return (forward_kinematics(setup.arm, q) * setup.T_flange_tool).topRightCorner<3, 1>();
}

/// @throws InvalidArgument naming the first pose with a number that is not finite
void require_finite(const RobotProgram& program);
/// @throws InvalidArgument as require_finite, or if the program has no motion to write
void require_motion(const RobotProgram& program);

/// Returns one line `# incise.KEY: VALUE` for each entry, with an entry for the digest (see sealed).
[[nodiscard]] std::string header_lines(const ProgramHeader& header);

/// Returns the names of the columns of to_joint_csv.
[[nodiscard]] std::string joint_csv_columns(const ArmModel& arm);

inline constexpr double kStartAcceleration = 0.5;  // rad/s² and rad/s: a slow motion to the start
inline constexpr double kStartSpeed = 0.3;

inline constexpr const char* kHeaderMark = "# incise.";

}  // namespace incise::robot_detail
