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

/// Statements of a written program about itself, as keys and values. The form depends on the file: comment lines `#
/// incise.KEY: VALUE` in a script, a table or YAML; the list `header` in JSON; a message in a bag. Keys may repeat.
/// program_from_text reads them back.
using ProgramHeader = std::vector<std::pair<std::string, std::string>>;

/// Returns the header of a program: kind, closed, lengths, tool, arm, branch, settings and limits, the path's waypoints
/// (from which the player knows the intended course), the tumour edge, and the checks that were made, overridden and
/// not made.
/// @param provenance  additional entries: inputs, hashes, version.
[[nodiscard]] ProgramHeader program_header(const RobotProgram& program, const ToolPath& path,
                                           const ProgramChecks& checks, const ProgramHeader& provenance = {});

/// Kind of motion commands in a URScript program.
enum class ScriptMotion {
  MoveP,  ///< `movel` and `movep` with blends: the controller computes the joints and keeps the tip's speed
  ServoJ  ///< a stream of joint positions at equal intervals of time
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
  v({"lookahead_s", "Lookahead of servoj: a shorter one gives less lag and less smoothing.", "s"}, s.lookahead_s,
    {0.03, 0.2});
  v("gain", s.gain, "Gain of servoj.", {100.0, 2000.0});
  v({"settle_s", "Rest added to servoj where a motion ends, to let the arm catch up.", "s"}, s.settle_s, {0.0, 5.0});
}
/// Returns every violation; empty if valid.
[[nodiscard]] std::vector<Problem> validate(const UrScriptSettings& settings);

/// Returns the program as a URScript function and a call to it: metres, seconds, axis-angle poses p[x, y, z, rx, ry,
/// rz] of the tool's tip in the base frame. The script sets the tool centre point and goes to the first joint positions
/// by `movej`, which determines the arm's branch. Then it runs the course: with MoveP by `movel` through the air, into
/// and out of the tissue, and by `movep` with blends along the cut; with ServoJ by one `servoj` per sample of the
/// motion, and more where a motion ends (UrScriptSettings::settle_s). It does not switch the electrode and opens no
/// connection.
/// @throws InvalidArgument if a number of the program is not finite, its motion was not found, or the settings are
/// invalid.
[[nodiscard]] std::string to_urscript(const RobotProgram& program, const ProgramHeader& header,
                                      const UrScriptSettings& settings = {});

/// Returns the motion as a CSV table: comment lines with the header, then the columns `time_s`, six joint positions
/// (`…_rad`, with the names of the maker's ROS description), six speeds (`…_rad_s`), six accelerations (`…_rad_s2`),
/// `tip_x_mm`, `tip_y_mm`, `tip_z_mm`, `phase`.
/// @throws InvalidArgument if a number of the program is not finite or its motion was not found.
[[nodiscard]] std::string to_joint_csv(const RobotProgram& program, const ProgramHeader& header);

/// Returns the motion as `trajectory_msgs/JointTrajectory` in YAML, for ROS 2 (`ros2 topic pub --file`): rad, rad/s,
/// rad/s²; frame_id `base`.
/// @throws InvalidArgument as to_joint_csv.
[[nodiscard]] std::string to_ros_yaml(const RobotProgram& program, const ProgramHeader& header);

/// Returns the bytes of a ROS 1 bag (format 2.0, not compressed, one chunk) with the same message on the topic
/// `/joint_trajectory`, and the header as `std_msgs/String` on `/incise/header`; both at time 1 s.
/// @throws InvalidArgument as to_joint_csv. Source: the published description of the format [RosbagFormat].
[[nodiscard]] std::string to_rosbag(const RobotProgram& program, const ProgramHeader& header);

/// Returns the program as JSON, mm, s and rad: `header`; `poses` with `phase`, `time_s`, `tip_mm`, `rotation_vector`,
/// `tip_speed_mm_s`, `depth_mm`, `waypoint`; `motion` with the arm's branch and `samples` [time_s, six joints, six
/// speeds]. If `checks` is given, also every check (name, passed, overridden, value, limit, relation, unit, pose,
/// waypoint, text) and `checks_not_made`. The motion may be one that was not found.
/// @throws InvalidArgument if a number of the program is not finite.
[[nodiscard]] std::string program_json(const RobotProgram& program, const ProgramChecks* checks = nullptr,
                                       const ProgramHeader& header = {});

}  // namespace incise
