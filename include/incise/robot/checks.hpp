#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/robot/program.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// What is known of the registration that put the path into the robot's frame.
struct RegistrationSummary {
  double scale = 1.0;  ///< between the clouds as the sensors gave them
  double rmse_mm = 0.0;
  double inlier_fraction = 1.0;
  bool is_converged = true;
};

/// Limits that a program is held to before it may be written for a robot.
struct CheckSettings {
  bool must_be_ring = true;     ///< the plan is a ring (plan.kind: ring), so the path has to be closed
  double min_speed_mm_s = 0.5;  ///< of the tip in the tissue
  double max_speed_mm_s = 30.0;
  double planned_depth_mm = kPlannedDepthMm;
  double depth_tolerance_mm = 0.5;
  double close_margin_mm = kCloseMarginMm;  ///< least distance of the path from the tumour edge, on its outside
  /// Neighbouring waypoints of a ring lie no farther apart than this many medians of these ways, or `max_gap_mm` …
  double max_gap_ratio = 4.0;
  double max_gap_mm = 2.0;  ///< … whichever is more
  /// Most that the tumour edge lies above or below the ring: beyond it the two are of different places.
  double max_edge_height_mm = 20.0;
  double max_tilt_deg = 80.0;            ///< of the tool from straight down
  double tool_table_clearance_mm = 1.0;  ///< least height of tip and shaft above the table
  double max_deviation_mm = 4.0;         ///< of the path from the intended one: more than any correction should ask for

  // Marking: in the place of the limits above.
  double mark_distance_mm = 0.3;  ///< most that a mark leaves the tumour edge by
  double mark_depth_mm = 1.0;
  double mark_depth_tolerance_mm = 0.3;
  double mark_speed_mm_s = 2.0;
  double mark_speed_tolerance = 0.01;  ///< as a share

  // The arm.
  double min_singular_value = 0.03;            ///< see smallest_singular_value
  double joint_margin_deg = 5.0;               ///< kept from the joints' limits
  double joint_speed_share = 0.5;              ///< of what the maker allows
  double max_joint_acceleration_rad_s2 = 5.0;  ///< the maker publishes none; his own programs' default is 1.4
  double table_clearance_mm = 20.0;            ///< of the links' hulls
  double arm_clearance_mm = 10.0;              ///< of the hulls of arm and instrument from each other and from the base
  double surface_clearance_mm = 10.0;          ///< of the arm's hulls from the tissue
  double tip_speed_tolerance = 0.01;           ///< as a share of the speed, away from the ends
  double max_chord_error_mm = 0.02;            ///< of the moves and their blends from the smooth course

  // The instrument: a needle, then a shaft up to the flange.
  double needle_length_mm = 25.0;
  double needle_radius_mm = 0.5;
  double shaft_radius_mm = 5.0;
  double shaft_clearance_mm = 1.0;
  double needle_clearance_mm = 1.0;  ///< of the needle above the place where it enters

  double min_power_w = 10.0, max_power_w = 60.0;

  double min_scale = 0.95, max_scale = 1.05;  ///< of the registration; both sensors are metric
  double max_rmse_mm = 1.0;
  double min_inlier_fraction = 0.5;
};

/// What a program is held against, as far as it is known.
struct CheckInputs {
  const ToolPath* intended = nullptr;  ///< the path before correction, in the robot's frame
  const TriMesh* surface = nullptr;    ///< the tissue in the robot's frame, mm; a cloud is a mesh without triangles
  std::optional<double> power_w{};
  std::optional<double> heat_half_width_mm{};  ///< how far beside the needle heat damages tissue
  std::optional<RegistrationSummary> registration{};
};

/// One named check: passed when `value` keeps to `limit` as `relation` says, or, without a relation, when `text` is
/// true.
struct ProgramCheck {
  std::string name;
  bool passed = false;
  double value = 0.0;
  double limit = 0.0;
  std::string relation = "<=";            ///< "<=", ">=", "<", ">", or empty for a plain yes or no
  std::string unit;                       ///< mm, mm/s or empty
  std::optional<std::size_t> pose;        ///< the worst pose of the program, where there is one
  std::string text;                       ///< for a person
  std::optional<std::size_t> waypoint{};  ///< of the path, at or before that pose
  bool is_overridden = false;             ///< a person has taken it on them
  /// "margin: 1.83 mm at waypoint 12 (pose 20), has to be >= 2.2 mm: least distance of …"
  [[nodiscard]] std::string message() const;
};
inline void describe(Visitor& v, ProgramCheck& c) {
  v("name", c.name, "Of the check.");
  v("passed", c.passed, "Whether the program keeps to it.");
  v("value", c.value, "What was found.");
  v("limit", c.limit, "What it is held against.");
  v("relation", c.relation, "What a good value is to the limit; empty: a plain yes or no.");
  v("unit", c.unit, "Of both.");
  v("pose", c.pose, "The worst pose of the program.", kNotNegative);
  v("text", c.text, "For a person.");
  v("waypoint", c.waypoint, "Of the path, at or before that pose.", kNotNegative);
  v("overridden", c.is_overridden, "A person has taken it on them.");
}

struct ProgramChecks {
  std::vector<ProgramCheck> checks;
  std::vector<std::string> not_made;  ///< what nobody has looked at: read it before a robot moves
  CheckSettings settings{};           ///< that they were made with
};

/// Checks a program and the path that it came from. Names of the checks, in this order:
/// - `finite`: every number of the program is finite; if not, no other check is made
/// - `frame`: the path is given in the robot's base frame
/// - `closed` (rings): the path is closed and the cut ends where it began, to 0.01 mm
/// - `gap` (rings): no two neighbouring waypoints lie far apart, which takes evenly spaced ones for granted
/// - `self_crossing`: the entry course crosses itself nowhere, seen along the mean axis
/// - `speed_min`, `speed_max`: nominal tip speed while cutting; a mark: within its tolerance of 2 mm/s
/// - `depth`: that planned within the tolerance, everywhere: below the surface if one is given, else as the path says
/// - `margin` (incisions): the needle keeps `close_margin_mm` outside the tumour edge where it enters, and its tip does
///   so too, seen along the mean axis. A ring without an edge fails, and so does an edge that crosses itself
///   in that view, one that is open, and one without area; only an open cut may have no edge at all
/// - `heat` (incisions; if the half width is given): it keeps farther from the edge than heat reaches
/// - `encloses` (rings, incisions): the ring goes round the tumour edge and lies at its height: its worst point is
/// named
/// - `edge_distance` (marks): neither the entry course nor the tumour edge leaves the other by more than
///   `mark_distance_mm`
/// - `deviation` (with an intended path): neither course is farther than `max_deviation_mm` from the other
/// - `chord_error`: straight moves and their blends stay near the smooth course
/// - `tilt`: the tool comes from above
/// - `tool_table`: tip and shaft stay above the table's plane
/// - `reach`: the arm reaches every pose on one branch, without a jump; if not, no check of joints is made
/// - `joint_limits`, `joint_speed`, `joint_acceleration`, `singularity`: of the arm's motion
/// - `tip_speed`: the tip's speed, from the joints, is the nominal one away from the ends
/// - `table`: the links stay clear of the table's plane
/// - `self_collision`: the hulls of the arm's links and of the instrument stay clear of each other
/// - `base`: they stay clear of the base's column and of the shoulder
/// - `surface_collision` (with a surface): the arm's hulls, flange included, stay clear of it
/// - `shaft` (with a surface): the instrument, straight from its needle's upper end to the flange, stays clear of it
/// - `needle` (with a surface): so does the needle: all of it on the way through the air, and in the tissue what lies
///   higher than the clearance (ProgramSettings::clearance_mm) above the entry
///
/// The last five look at the whole motion, from the first approach to the end of the retreat, and between its samples:
/// their values are least distances, less what the hulls can move by in half a period.
///
/// - `power` (if given): within the generator's usual range for cutting
/// - `registration_scale`, `registration_rmse`, `registration_inliers`, `registration_converged` (if given)
///
/// Forces, the electrode's switching, cables, other things in the room and how well the controller keeps to its path
/// are **not** checked; `not_made` lists them, together with checks that lack their input.
[[nodiscard]] ProgramChecks check_program(const RobotProgram& program, const ToolPath& path,
                                          const CheckSettings& settings = {}, const CheckInputs& inputs = {});

/// The longest way between neighbouring waypoints of a ring, and the most that the check `gap` lets pass.
struct WaypointGap {
  double longest_mm = 0.0;
  double limit_mm = 0.0;
  std::size_t after = 0;  ///< the waypoint before it
};
/// @pre at least one waypoint.
[[nodiscard]] WaypointGap widest_gap(const ToolPath& path, const CheckSettings& settings = {});

/// Angle of a tool's axis (unit, into the tissue) from straight down, degrees; what the check `tilt` looks at.
[[nodiscard]] double tilt_deg(const Vec3& axis);

/// Every name that check_program may give.
[[nodiscard]] std::span<const char* const> check_names();

/// Whether a person may take a failed check on them. Not `finite` and `frame`, whose program would be nonsense, not
/// `reach`, without which there is no motion to write, and not `margin`: a cut that comes near the tumour is refused.
/// Who plans a smaller margin says so by CheckLimits::close_margin_mm, which the program states.
[[nodiscard]] bool can_be_overridden(const std::string& check);

/// Marks failed checks of these names as overridden. @pre known names that can be overridden (InvalidArgument).
void override_checks(ProgramChecks& checks, const std::vector<std::string>& names);

}  // namespace incise
