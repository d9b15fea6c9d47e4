#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/robot/program_reading.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Settings and limits of the player.
struct PlayerSettings {
  double speed_slider = 1.0;
  double cycle_s = 0.002;
  double end_zone_mm = 2.0;
  double max_deviation_mm = 1.0;
  // Limits for a program whose header gives its path and settings, along the course of that path.
  double max_lean_deg = 2.0;
  double speed_tolerance = 0.05;
  double max_way_back_mm = 0.2;
  double max_way_left_mm = 2.0;
  double max_rest_s = 1.5;
};
inline void describe(Visitor& v, PlayerSettings& s) {
  v("speed_slider", s.speed_slider, "Setting of the controller's speed slider, as a share.", {0.0, 1.0, true});
  v({"cycle_s", "Cycle time of the controller; 0.002: 500 Hz.", "s"}, s.cycle_s, {1e-4, 0.02});
  v({"end_zone_mm", "Length of the cut at either end in which the tip speeds up or slows down.", "mm"}, s.end_zone_mm,
    kNotNegative);
  v({"max_deviation_mm", "Greatest distance of the tip from the intended course, for a success.", "mm"},
    s.max_deviation_mm, kPositive);
  v({"max_lean_deg", "Greatest angle of the tool's axis from the intended one.", "deg"}, s.max_lean_deg, kPositive);
  v("speed_tolerance", s.speed_tolerance, "Share by which the tip may be faster than intended, or slower in the cut.",
    kPositive);
  v({"max_way_back_mm", "Greatest distance that the tip may go back along the course.", "mm"}, s.max_way_back_mm,
    kPositive);
  v({"max_way_left_mm", "Greatest length of the course that may be left out at its beginning or end.", "mm"},
    s.max_way_left_mm, kPositive);
  v({"max_rest_s", "Longest rest in the tissue beyond the intended dwell; a stream rests where a motion ends.", "s"},
    s.max_rest_s, kPositive);
}

/// How a replay ended. With StartsInTissue, EndsInTissue and all outcomes from JointSpeed on, the program ran to its
/// end; the other failures ended it early.
enum class ReplayOutcome {
  Completed,
  Unreachable,     ///< a pose of a straight or blended move cannot be reached
  Jump,            ///< a joint would have to jump: the move crosses a singularity
  BlendsOverlap,   ///< two blends of a move are together longer than the distance between their poses
  JointLimits,     ///< a joint is sent beyond its limits
  StartsInTissue,  ///< the first tip position lies below the surface: the way to it leads through tissue
  EndsInTissue,    ///< the last tip position lies below the surface
  TooLong,         ///< it would take longer than kLongestProgramS
  JointSpeed,      ///< a joint is sent faster than it can turn
  OffCourse,       ///< the tip leaves the intended course by more than `max_deviation_mm`
  WrongAxis,       ///< the tool leans too far from the intended axis
  WrongOrder,      ///< the tip goes back on its course, or omits its beginning or end
  WrongSpeed,      ///< the tip is faster than intended, or slower in the cut, or a move has too much acceleration
  RestsInTissue,   ///< the tip rests in the tissue for longer than intended
  BreaksLimit,     ///< the arm comes too near to the table, its base, itself, a joint's limit or a singularity
  Altered,         ///< it is not the program that was checked: its digest differs
  FalseChecks      ///< its header contradicts the checks that are computed again
};
inline constexpr std::array<std::string_view, 17> kReplayOutcomeNames{
    "completed",      "unreachable",     "jump",         "blends_overlap", "joint_limits", "starts_in_tissue",
    "ends_in_tissue", "too_long",        "joint_speed",  "off_course",     "wrong_axis",   "wrong_order",
    "wrong_speed",    "rests_in_tissue", "breaks_limit", "altered",        "false_checks"};
[[nodiscard]] constexpr Names names_of(ReplayOutcome) {
  return kReplayOutcomeNames;
}

/// The arm at the end of one cycle; points and directions in the base frame.
struct ReplaySample {
  double time_s = 0.0;
  Joints q_rad = Joints::Zero();
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();   ///< of the tool, unit, out of its tip
  double tip_speed_mm_s = 0.0;  ///< mean over the previous cycle
  double deviation_mm = 0.0;    ///< distance of the tip from the intended course; 0 if none is known
  ProgramPhase phase = ProgramPhase::Approach;
};

inline void describe(Visitor& v, ReplaySample& s) {
  v({"time_s", "From the start of the program.", "s"}, s.time_s);
  v({"q_rad", "Joint angles.", "rad"}, s.q_rad);
  v({"tip_mm", "Position of the tool's tip.", "mm"}, s.tip_mm);
  v("axis", s.axis, "Axis of the tool, pointing out of its tip.");
  v({"tip_speed_mm_s", "Mean speed of the tip over the previous cycle.", "mm/s"}, s.tip_speed_mm_s);
  v({"deviation_mm", "Distance of the tip from the intended course; 0 if the course is not known.", "mm"},
    s.deviation_mm);
  v("phase", s.phase, "Phase of the program.");
}

struct SpeedNumbers {
  double mean = 0.0, min = 0.0, max = 0.0;
};
inline void describe(Visitor& v, SpeedNumbers& n) {
  v("mean", n.mean, "Mean over time.");
  v("min", n.min, "Least value.");
  v("max", n.max, "Greatest value.");
}

/// Result of playing a program: the arm's simulated motion and how well it follows the intended course.
struct [[nodiscard]] Replay {
  ReplayOutcome outcome = ReplayOutcome::Completed;
  std::size_t line = 0;  ///< line of the program that ends the replay early or demands too much; 0 if none
  std::string reason;    ///< for a person; empty if the outcome needs no explanation
  std::vector<ReplaySample> samples;
  Points intended_mm;  ///< the intended course of the tip as a fine polyline: plunge, cut with overlap, exit
  double max_deviation_mm = 0.0;      ///< of the tip from the intended course, over the whole program
  double max_cut_deviation_mm = 0.0;  ///< in the cut; for a program without a cut, over the whole program
  double mean_deviation_mm = 0.0;     ///< in the cut
  double max_deviation_at_s = 0.0;
  SpeedNumbers tip_speed_mm_s;         ///< in the cut, away from its ends
  double max_joint_speed_share = 0.0;  ///< of the joint's greatest speed
  double min_singular_value = 0.0;     ///< see smallest_singular_value
  PlayerSettings settings;             ///< the settings that were used
  [[nodiscard]] double duration_s() const { return samples.empty() ? 0.0 : samples.back().time_s; }
};
void describe(Visitor& v, Replay& r);

/// Plays a program cycle by cycle through incise's kinematics and a model of the controller (docs/models/robot.md):
/// - movej: not played; the replay begins at its end
/// - movel, movep: straight between poses; at a blended corner, the circle that touches both sides at the blend radius.
///   Speed and acceleration as given (trapezoid). Joints: the solution of inverse_kinematics nearest to the previous
///   joints. The slider slows time; the path stays the same
/// - servoj: each joint follows its target as q'' = gain (q_target - q - lookahead q'). The slider slows the arm, not
///   the stream
/// - a timed list of joints: cubic between rows, with the rows' speeds. The slider slows time
///
/// The tip's position in the cut is compared with `intended`. If the program's header gives the path and settings that
/// the program was made with, position, axis, order, speed and rests are also compared with that path's course, in
/// every phase, the way through the air included. The motion must also keep the limits of the arm's checks: those in
/// the header, otherwise the defaults. If a program that runs to its end has several faults, the outcome is the first
/// of them in the order of ReplayOutcome. `play` does not check the digest or the header's statements; see judge_audit.
/// @param intended  the path that the tip should follow, frame robot; by default the path in the program's header.
///   Without either, deviations are 0 and `intended_mm` is empty.
/// @throws InvalidArgument for settings out of range, or unless the program has at least 2 rows of joints or, without
/// joints, at least 2 commands.
[[nodiscard]] Replay play(const WrittenProgram& program, const ArmModel& arm = ur10e(),
                          const PlayerSettings& settings = {}, const ToolPath* intended = nullptr);

}  // namespace incise
