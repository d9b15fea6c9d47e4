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
  std::size_t line = 0;
};

/// One row of a timed list of joints.
struct TimedJoints {
  double time_s = 0.0;
  Joints q_rad = Joints::Zero();
  Joints speed_rad_s = Joints::Zero();
  ProgramPhase phase = ProgramPhase::Approach;
  std::size_t line = 0;  ///< of the table; 0: none (JSON)
  // What the player does not need, and another may run by. Of a table alone.
  std::optional<Joints> acceleration_rad_s2 = {};
  std::optional<Vec3> tip_mm = {};
};

/// Whether a program is, to the byte, the one that was written and checked.
enum class ProgramDigest {
  Absent,   ///< it carries no digest: it is another's, or older than digests
  Matches,  ///< it is
  Differs   ///< it was changed afterwards, or put together by hand
};
inline constexpr std::array<std::string_view, 3> kProgramDigestNames{"absent", "matches", "differs"};
[[nodiscard]] constexpr Names names_of(ProgramDigest) {
  return kProgramDigestNames;
}

/// What a program was made with and held to.
struct ProgramRecord {
  ProgramSettings settings;
  ArmSetup setup;
  CheckSettings limits;
};

/// A program that was written by to_urscript, to_joint_csv or to_json, read back. Either `commands` or `joints` is
/// filled.
struct WrittenProgram {
  ProgramHeader header;
  std::vector<ScriptCommand> commands;
  std::vector<TimedJoints> joints;
  Mat4 T_flange_tool = Mat4::Identity();
  std::optional<ToolPath> path;         ///< that it was made for, from its header, in the robot's frame
  std::optional<ProgramRecord> record;  ///< from its header, where that is complete
  ProgramDigest digest = ProgramDigest::Absent;
  std::vector<std::string> listed_checks;  ///< of JSON: the checks beside the header, in the header's words
  std::vector<ProgramPose> listed_poses;   ///< of JSON: beside the motion; without the tool's rotation matrix
  double overlap_mm = 0.0, clearance_mm = 0.0, approach_height_mm = 0.0;
};

/// Reads a program's text, by the ending of its name: `.csv` and `.json`, else URScript. Of URScript only what
/// to_urscript writes is known: comments, one function with `set_tcp`, `movej`, `movel`, `movep`, `servoj`, `sleep`,
/// `stopj`, its `end` and its call.
/// @throws DataError naming the line, what was found and what was expected: another statement, a wrong number of
/// arguments, a number out of range, an end that is missing, a table with other columns, a key that is there twice,
/// lengths in the header that no program has, a character that no program holds (another reader may take it for the end
/// of a comment's line); or the file's kind, of those that are written for others (.yaml, .bag).
[[nodiscard]] WrittenProgram program_from_text(std::string_view text, const std::filesystem::path& name);

}  // namespace incise
