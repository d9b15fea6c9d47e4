#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/robot/joint_motion.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Phase of a program. A pose has the phase of the move that ends at it.
enum class ProgramPhase {
  Approach,  ///< through the air, towards the entry
  Plunge,    ///< along the axis into the tissue
  Cut,       ///< along the path
  Overlap,   ///< along the first part of a closed path again
  Dwell,     ///< rest at the end of the cut
  Exit,      ///< back out along the axis
  Retreat    ///< away through the air
};
inline constexpr std::array<std::string_view, 7> kProgramPhaseNames{"approach", "plunge", "cut",    "overlap",
                                                                    "dwell",    "exit",   "retreat"};
[[nodiscard]] constexpr Names names_of(ProgramPhase) {
  return kProgramPhaseNames;
}
/// Whether a phase belongs to the cut: it leads along the path, not through the air or along the axis.
[[nodiscard]] constexpr bool is_cut(ProgramPhase phase) {
  return phase == ProgramPhase::Cut || phase == ProgramPhase::Overlap;
}

/// Longest overlap, clearance, approach height or depth of a program, mm: the arm reaches no farther than 1300.
inline constexpr double kLargestLengthMm = 1000.0;

/// Settings of make_program.
struct ProgramSettings {
  double approach_height_mm = 30.0;
  double clearance_mm = 5.0;
  double approach_speed_mm_s = 50.0;
  double plunge_speed_mm_s = 7.0;
  double overlap_mm = kRingOverlapMm;
  double dwell_s = 0.0;
  double chord_error_mm = 0.02;
  double max_spacing_mm = 2.0;
  double acceleration_mm_s2 = 100.0;
  double jerk_mm_s3 = 2000.0;
  Vec3 tool_x_hint = Vec3::UnitX();
  std::optional<double> spin_deg{};
};
inline void describe(Visitor& v, ProgramSettings& s) {
  v({"approach_height_mm", "Height of the tip above the entry in the first and the last pose, along the tool's axis.",
     "mm"},
    s.approach_height_mm, {0.0, kLargestLengthMm});
  v({"clearance_mm", "Height at which the fast approach ends and the plunge begins.", "mm"}, s.clearance_mm, kPositive);
  v({"approach_speed_mm_s", "Speed through the air.", "mm/s"}, s.approach_speed_mm_s, kPositive);
  v({"plunge_speed_mm_s", "Speed into the tissue and out of it.", "mm/s"}, s.plunge_speed_mm_s, kPositive);
  v({"overlap_mm", "Distance that a closed path continues beyond its start; without it, the ring may stay open.", "mm"},
    s.overlap_mm, {0.0, kLargestLengthMm});
  v({"dwell_s", "Rest at the end of the cut, before the exit.", "s"}, s.dwell_s, kNotNegative);
  v({"chord_error_mm", "Greatest deviation of the straight moves between poses from the smooth course.", "mm"},
    s.chord_error_mm, kPositive);
  v({"max_spacing_mm", "Greatest spacing of the poses along the cut.", "mm"}, s.max_spacing_mm, kPositive);
  v({"acceleration_mm_s2", "Greatest acceleration and deceleration of the tip.", "mm/s2"}, s.acceleration_mm_s2,
    kPositive);
  v({"jerk_mm_s3", "Greatest rate at which that acceleration changes.", "mm/s3"}, s.jerk_mm_s3, kPositive);
  v.direction("tool_x_hint", s.tool_x_hint,
              "The tool's x axis lies as close to this direction as its mean z axis allows.");
  v({"spin_deg", "Turn from there about that mean axis; absent: the turn that suits the arm best (a needle is round).",
     "deg"},
    s.spin_deg);
}
/// Greatest duration of a program. The paper's ring takes half a minute; more than two hours indicates a wrong unit.
inline constexpr double kLongestProgramS = 2.0 * 3600.0;
/// Greatest coordinate of a waypoint, mm: no place near an arm lies beyond it, and squares of larger numbers may
/// overflow.
inline constexpr double kFarthestPlaceMm = 1e5;
/// Returns every violation; empty if valid.
[[nodiscard]] std::vector<Problem> validate(const ProgramSettings& settings);

/// One pose of the tool, in the robot's base frame.
struct ProgramPose {
  Vec3 tip_mm = Vec3::Zero();            ///< the tool's tip
  Mat3 R_robot_tool = Mat3::Identity();  ///< columns: the tool's axes; z points along the tool, out of its tip
  Vec3 rotation_vector = Vec3::Zero();   ///< the same rotation as axis times angle, rad; continuous along the program,
                                         ///< so the angle may exceed pi
  double time_s = 0.0;                   ///< from the start of the program
  double tip_speed_mm_s = 0.0;           ///< of the move that ends here; 0 for the first pose and the dwell
  double depth_mm = 0.0;                 ///< of the tip below the surface along the axis; negative above it
  ProgramPhase phase = ProgramPhase::Approach;
  std::size_t waypoint = 0;  ///< index of the path's waypoint at or before this pose

  /// Returns the point where the tool's axis meets the tissue's surface.
  [[nodiscard]] Vec3 entry_mm() const { return tip_mm - depth_mm * R_robot_tool.col(2); }
};

/// A timed list of tool poses, with the arm's motion along them. The tip starts, stops and changes its speed by
/// S-curves (bounded acceleration and jerk); elsewhere its speed is constant.
struct RobotProgram {
  std::vector<ProgramPose> poses;
  PathKind kind = PathKind::Incise;
  bool is_closed = true;
  double cut_length_mm = 0.0;   ///< of the tip's course along the path, without overlap
  double overlap_mm = 0.0;      ///< the setting for a closed path, otherwise 0
  double spacing_mm = 0.0;      ///< of the poses along the cut
  double chord_error_mm = 0.0;  ///< greatest distance found between the moves and the smooth course
  ProgramSettings settings{};   ///< settings that the program was made with
  ArmSetup setup{};             ///< arm, tool and table that it was made for
  JointMotion motion{};         ///< the arm along the whole course; without samples if the arm cannot follow it
  [[nodiscard]] double duration_s() const { return poses.empty() ? 0.0 : poses.back().time_s; }
};

/// Returns T_flange_tool, 4 x 4, mm, from the numbers that the teach pendant shows: the position of the tip in the
/// flange's frame, and the rotation as axis times angle, rad.
[[nodiscard]] Mat4 tool_pose(const Vec3& tip_mm, const Vec3& rotation_vector);

/// Requires that a path is given in the robot's base frame.
/// @param file  names the path in the message.
/// @throws DataError "<file>: frame: found sim_rest, expected robot. …"
void require_robot_frame(const ToolPath& path, const std::filesystem::path& file);

/// Makes a program from a path. The tip starts above the entry, goes down to the clearance, along the axis to depth,
/// along the path at the path's speeds, along the overlap (closed paths), rests, goes out along the axis and retreats.
///
/// The tip follows a smooth curve through the waypoints' tips, with continuous direction and curvature
/// (docs/models/robot.md). Poses are evenly spaced along it, as far apart as `chord_error_mm` and `max_spacing_mm`
/// allow. Phases begin and end at rest; only the overlap continues the cut without a stop. The tool's frame is the
/// frame about the mean axis, turned by the shortest rotation to the local axis. No turn about the tool's axis
/// accumulates, so a ring ends as it began.
/// Then the arm's joints along that course are computed (`motion`), on one of the eight branches throughout.
/// @param path  frame robot; at least 3 waypoints (2 if open), tips of neighbours more than 1 µm apart, finite, unit
///   axes.
/// @throws InvalidArgument if the path, the settings or the setup is invalid, if an axis lies more than 120 degrees
/// from the mean axis, if the overlap is not shorter than a closed path, or if the program would take longer than
/// kLongestProgramS. An arm that cannot follow is no error: see JointMotion::outcome.
[[nodiscard]] RobotProgram make_program(const ToolPath& path, const ProgramSettings& settings = {},
                                        const ArmSetup& setup = {});

}  // namespace incise
