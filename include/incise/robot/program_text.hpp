#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/program.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace incise {

/// What every written program says of itself, in the form's own way: comment lines `# incise.KEY: VALUE` of a script, a
/// table or YAML, the object `header` of JSON, a message of a bag. Keys may repeat. The player reads them back.
using ProgramHeader = std::vector<std::pair<std::string, std::string>>;

/// The heading of a program: kind, closed, lengths, tool, arm, branch, the path's waypoints (so that the player knows
/// the intended course), the checks made, those overridden and not made.
/// @param provenance  added lines, key and value: what it was made from, hashes, version.
[[nodiscard]] ProgramHeader program_header(const RobotProgram& program, const ToolPath& path,
                                           const ProgramChecks& checks, const ProgramHeader& provenance = {});

/// How a program is written as URScript.
enum class ScriptMotion {
  MoveP,  ///< `movel` and `movep` with blends: the controller finds the joints and keeps the tip's speed
  ServoJ  ///< a stream of joint positions at even times
};
inline constexpr std::array<std::string_view, 2> kScriptMotionNames{"movep", "servoj"};
[[nodiscard]] constexpr Names names_of(ScriptMotion) {
  return kScriptMotionNames;
}
struct UrScriptSettings {
  ScriptMotion motion = ScriptMotion::MoveP;
  std::string function_name = "incise_cut";
  double blend_fraction = 0.4;
  double lookahead_s = 0.1;
  double gain = 300.0;
  double settle_s = 0.4;
};
inline void describe(Visitor& v, UrScriptSettings& s) {
  v("motion", s.motion, "movep (blends, constant speed) or servoj (timed joints).");
  v("function_name", s.function_name, "Letters, digits and _, not starting with a digit.");
  v("blend_fraction", s.blend_fraction, "Blend radius of the cut's poses, as a fraction of their spacing.",
    {0.0, 0.5, false, true});
  v({"lookahead_s", "Of servoj: less lag, less smoothing.", "s"}, s.lookahead_s, {0.03, 0.2});
  v("gain", s.gain, "Of servoj.", {100.0, 2000.0});
  v({"settle_s", "Of servoj: rest added where a motion ends, so that the arm has caught up.", "s"}, s.settle_s,
    {0.0, 5.0});
}
/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const UrScriptSettings& settings);

/// The program as a URScript function and a call to it: metres, seconds, axis-angle poses p[x, y, z, rx, ry, rz] of the
/// tool's tip in the base frame. It sets the tool centre point, goes to the first joint positions by `movej` (this
/// settles the arm's branch) and then runs the course: with MoveP by `movel` through the air, into and out of the
/// tissue, and by `movep` with blends along the cut; with ServoJ by one `servoj` per sample of the motion. The power of
/// the electrode is not switched. Nothing in it opens a connection. A comment says that it comes from a simulation.
/// @pre the program's numbers are finite, its motion was found, the settings are valid (InvalidArgument).
[[nodiscard]] std::string to_urscript(const RobotProgram& program, const ProgramHeader& header,
                                      const UrScriptSettings& settings = {});

/// The motion as a table: comment lines with the header, then `time_s`, six joint positions (rad, named as in the
/// maker's ROS description), six speeds (`…_rad_s`), six accelerations (`…_rad_s2`), `tip_x_mm`, `tip_y_mm`,
/// `tip_z_mm`, `phase`. @pre as to_urscript
[[nodiscard]] std::string to_joint_csv(const RobotProgram& program, const ProgramHeader& header);

/// The motion as `trajectory_msgs/JointTrajectory` in YAML, as ROS 2 reads it (`ros2 topic pub --file`): rad, rad/s,
/// rad/s²; frame_id `base`. @pre as to_urscript
[[nodiscard]] std::string to_ros_yaml(const RobotProgram& program, const ProgramHeader& header);

/// The same message as a ROS 1 bag (format 2.0, not compressed, one chunk): topic `/joint_trajectory`, and the header
/// as `std_msgs/String` on `/incise/header`; both at time 1 s. Source: the format's published description
/// [RosbagFormat].
/// @pre as to_urscript
[[nodiscard]] std::string to_rosbag(const RobotProgram& program, const ProgramHeader& header);

/// The program as JSON, mm, s and rad: `header`, `poses` with `phase`, `time_s`, `tip_mm`, `rotation_vector`,
/// `tip_speed_mm_s`, `depth_mm`; with `checks` given, also every check (name, passed, overridden, value, limit, unit,
/// pose, waypoint, text) and `checks_not_made`; and `motion` with the arm's branch and `samples` [time_s, six joints,
/// six speeds].
/// @pre the program's numbers are finite (InvalidArgument).
[[nodiscard]] std::string program_json(const RobotProgram& program, const ProgramChecks* checks = nullptr,
                                       const ProgramHeader& header = {});

}  // namespace incise
