#pragma once

#include <incise/core/names.hpp>
#include <incise/robot/program_text.hpp>

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace incise {

/// One motion command of a script, in mm, rad and s.
struct ScriptCommand {
  enum class Kind { MoveJ, MoveL, MoveP, ServoJ, Sleep, StopJ };
  Kind kind = Kind::MoveJ;
  Joints q_rad = Joints::Zero();         ///< MoveJ, ServoJ
  Vec3 tip_mm = Vec3::Zero();            ///< MoveL, MoveP
  Vec3 rotation_vector = Vec3::Zero();   ///< MoveL, MoveP
  double acceleration = 0.0;             ///< mm/s², or rad/s² of joints
  double speed = 0.0;                    ///< mm/s, or rad/s of joints
  double blend_mm = 0.0;                 ///< MoveP
  double seconds = 0.0;                  ///< ServoJ, Sleep
  double lookahead_s = 0.0, gain = 0.0;  ///< ServoJ
  ProgramPhase phase = ProgramPhase::Approach;
  std::size_t line = 0;  ///< of the file, from 1
};

/// One row of a timed list of joints.
struct TimedJoints {
  double time_s = 0.0;
  Joints q_rad = Joints::Zero();
  Joints speed_rad_s = Joints::Zero();
  ProgramPhase phase = ProgramPhase::Approach;
  std::size_t line = 0;  ///< of the table; 0: none (JSON)
  // The player does not need these, but another program may run by them. Only a table has them.
  std::optional<Joints> acceleration_rad_s2 = {};
  std::optional<Vec3> tip_mm = {};
};

/// Whether a program is, to the byte, the one that was written and checked.
enum class ProgramDigest {
  Absent,   ///< it has no digest: incise did not write it, or an early version did
  Matches,  ///< it is unchanged
  Differs   ///< it was changed afterwards, or put together by hand
};
inline constexpr std::array<std::string_view, 3> kProgramDigestNames{"absent", "matches", "differs"};
[[nodiscard]] constexpr Names names_of(ProgramDigest) {
  return kProgramDigestNames;
}

/// Settings, arm and limits with which a program was made and checked.
struct ProgramRecord {
  ProgramSettings settings;
  ArmSetup setup;
  CheckSettings limits;
};

/// A program that was written by to_urscript, to_joint_csv or program_json, read back. Either `commands` or `joints` is
/// filled.
struct WrittenProgram {
  ProgramHeader header;
  std::vector<ScriptCommand> commands;
  std::vector<TimedJoints> joints;
  Mat4 T_flange_tool = Mat4::Identity();
  std::optional<ToolPath> path;         ///< path that it was made for, from its header, frame robot
  std::optional<ProgramRecord> record;  ///< from its header, if that is complete
  ProgramDigest digest = ProgramDigest::Absent;
  std::vector<std::string> listed_checks;  ///< JSON only: its list `checks`, in the header's words
  std::vector<ProgramPose> listed_poses;   ///< JSON only: its list `poses`; without the tool's rotation matrix
  double overlap_mm = 0.0, clearance_mm = 0.0, approach_height_mm = 0.0;
};

/// Reads a program from text: as a table or JSON if the name ends in `.csv` or `.json`, otherwise as URScript. Of
/// URScript it knows only what to_urscript writes: comments, and one function with `set_tcp`, `movej`, `movel`,
/// `movep`, `servoj`, `sleep` and `stopj`, its `end` and its call.
/// @throws DataError naming the line, what was found and what was expected: for another statement, a wrong number of
/// arguments, a number out of range, a missing end, other columns in a table, a key that occurs twice, impossible
/// lengths in the header, or a character that no program contains (another reader might take it for the end of a
/// comment line). Also for `.yaml` and `.bag`, which are written for ROS only.
[[nodiscard]] WrittenProgram program_from_text(std::string_view text, const std::filesystem::path& name);

}  // namespace incise
