#pragma once

#include <incise/robot/program_text.hpp>

#include <string>

namespace incise::robot_detail {

/// Whether a pose belongs to the cut: it is reached along the path, not through the air or along the axis.
[[nodiscard]] inline bool is_cut(const ProgramPose& pose) {
  return pose.phase == ProgramPhase::Cut || pose.phase == ProgramPhase::Overlap;
}

/// @throws InvalidArgument naming the first pose with a number that is not finite
void require_finite(const RobotProgram& program);
/// @throws InvalidArgument if the program has no motion to write
void require_motion(const RobotProgram& program);

/// Returns one line `# incise.KEY: VALUE` for each entry, with an entry for the digest (see sealed).
[[nodiscard]] std::string header_lines(const ProgramHeader& header);

inline constexpr double kStartAcceleration = 0.5;  // rad/s² and rad/s: a slow motion to the start
inline constexpr double kStartSpeed = 0.3;

inline constexpr const char* kHeaderMark = "# incise.";

}  // namespace incise::robot_detail
