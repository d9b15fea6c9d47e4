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

/// Quality of the registration that transformed the path into the robot's frame.
struct RegistrationSummary {
  double scale = 1.0;  ///< between the clouds as the sensors gave them
  double rmse_mm = 0.0;
  double inlier_fraction = 1.0;
  bool is_converged = true;
};

/// Limits that a program must keep before it may be written for a robot.
struct CheckSettings {
  bool must_be_ring = true;     ///< the plan is a ring (plan.kind: ring), so the path has to be closed
  double min_speed_mm_s = 0.5;  ///< of the tip in the tissue
  double max_speed_mm_s = 30.0;
  double planned_depth_mm = kPlannedDepthMm;
  double depth_tolerance_mm = 0.5;
  double close_margin_mm = kCloseMarginMm;  ///< least distance of the path from the tumour edge, on its outside
  /// Greatest distance between neighbouring waypoints of a ring, in medians of these distances. The limit is this or
  /// `max_gap_mm`, whichever is more.
  double max_gap_ratio = 4.0;
  double max_gap_mm = 2.0;
  /// Greatest height of the tumour edge above or below the ring: beyond it, the two do not belong together.
  double max_edge_height_mm = 20.0;
  double max_tilt_deg = 80.0;            ///< of the tool from straight down
  double tool_table_clearance_mm = 1.0;  ///< least height of tip and shaft above the table
  double max_deviation_mm = 4.0;         ///< of the path from the intended one: more than any correction should need

  // Marks, instead of the limits above.
  double mark_distance_mm = 0.3;  ///< greatest distance of a mark from the tumour edge, and of the edge from the mark
  double mark_depth_mm = 1.0;
  double mark_depth_tolerance_mm = 0.3;
  double mark_speed_mm_s = 2.0;
  double mark_speed_tolerance = 0.01;  ///< as a share

  // The arm.
  double min_singular_value = 0.03;            ///< see smallest_singular_value
  double joint_margin_deg = 5.0;               ///< kept from the joints' limits
  double joint_speed_share = 0.5;              ///< of the maker's limit
  double max_joint_acceleration_rad_s2 = 5.0;  ///< the maker publishes none; the default in its programs is 1.4
  double table_clearance_mm = 20.0;            ///< of the links' hulls
  double arm_clearance_mm = 10.0;              ///< of the hulls of arm and instrument from each other and from the base
  double surface_clearance_mm = 10.0;          ///< of the arm's hulls from the tissue
  double tip_speed_tolerance = 0.01;           ///< as a share of the nominal speed, away from ends and changes
  double max_chord_error_mm = 0.02;            ///< of the moves and their blends from the smooth course

  // The instrument: a needle, then a shaft up to the flange.
  double needle_length_mm = 25.0;
  double needle_radius_mm = 0.5;
  double shaft_radius_mm = 5.0;
  double shaft_clearance_mm = 1.0;
  double needle_clearance_mm = 1.0;  ///< of the needle from the tissue, except near its entry

  double min_power_w = 10.0, max_power_w = 60.0;

  double min_scale = 0.95, max_scale = 1.05;  ///< of the registration; both sensors are metric
  double max_rmse_mm = 1.0;
  double min_inlier_fraction = 0.5;
};

/// Data that some checks need, as far as it is available. The caller keeps ownership of the pointers.
struct CheckInputs {
  const ToolPath* intended = nullptr;  ///< the path before correction, in the robot's frame
  const TriMesh* surface = nullptr;    ///< the tissue's surface, robot frame, mm; a cloud is a mesh without triangles
  std::optional<double> power_w{};
  std::optional<double> heat_half_width_mm{};  ///< distance beside the needle to which heat damages tissue
  std::optional<RegistrationSummary> registration{};
};

/// Result of one named check. It is passed if `value` `relation` `limit` holds. A check without a relation is a yes or
/// no: `value` is 1 if `text` is true, otherwise 0, and `limit` is 1.
struct ProgramCheck {
  std::string name;
  bool passed = false;
  double value = 0.0;
  double limit = 0.0;
  std::string relation = "<=";            ///< "<=", ">=", "<", ">", or empty for a yes or no
  std::string unit;                       ///< of value and limit: mm, mm/s, deg, rad/s2, W, or empty
  std::optional<std::size_t> pose;        ///< index of the worst pose of the program, if any
  std::string text;                       ///< meaning of the check, for a person
  std::optional<std::size_t> waypoint{};  ///< index of the path's waypoint at or before that pose
  bool is_overridden = false;             ///< a person has taken responsibility for the failed check
  /// Returns one sentence: "margin: 1.83 mm at waypoint 12 (pose 20), must be >= 2.2 mm: least distance of …".
  [[nodiscard]] std::string message() const;
};
inline void describe(Visitor& v, ProgramCheck& c) {
  v("name", c.name, "Name of the check.");
  v("passed", c.passed, "Whether the program passes the check.");
  v("value", c.value, "Value that was found.");
  v("limit", c.limit, "Limit of the value.");
  v("relation", c.relation, "Relation that the value must have to the limit; empty: a yes or no.");
  v("unit", c.unit, "Unit of the value and the limit.");
  v("pose", c.pose, "Index of the worst pose of the program.", kNotNegative);
  v("text", c.text, "Meaning of the check, for a person.");
  v("waypoint", c.waypoint, "Index of the path's waypoint at or before that pose.", kNotNegative);
  v("overridden", c.is_overridden, "Whether a person has taken responsibility for the failed check.");
}

struct ProgramChecks {
  std::vector<ProgramCheck> checks;
  std::vector<std::string> not_made;  ///< what was not checked, and why: read it before a robot moves
  CheckSettings settings{};           ///< the limits that were used
};

/// Checks a program and the path that it was made from. The checks, in this order:
/// - `finite`: every number of the program is finite; if not, no other check is made
/// - `frame`: the path is given in the robot's base frame
/// - `closed` (rings): the path is closed and the cut ends where it began, to 0.01 mm
/// - `gap` (rings): no two neighbouring waypoints lie far apart; assumes that waypoints are evenly spaced
/// - `self_crossing`: the line of the entry points does not cross itself, seen along the mean axis
/// - `speed_min`, `speed_max`: nominal tip speed along the cut; of a mark: within the tolerance of `mark_speed_mm_s`
/// - `depth`: everywhere the planned depth, within the tolerance; measured below the surface if one is given, otherwise
///   taken from the path
/// - `margin` (incisions): the needle stays at least `close_margin_mm` outside the tumour edge, at its entry and, seen
///   along the mean axis, at its tip. A ring without an edge fails. So does an edge that is open, has no area or
///   crosses itself in that view. Only an open cut may have no edge
/// - `heat` (incisions; if the half width is given): the needle stays at least that half width outside the edge
/// - `encloses` (rings, incisions): the ring encloses the tumour edge and lies near its height; the text gives the
///   edge's worst point
/// - `edge_distance` (marks): no entry point is farther than `mark_distance_mm` from the tumour edge, and no point of
///   the edge is farther than that from the mark
/// - `deviation` (with an intended path): neither path is anywhere farther than `max_deviation_mm` from the other
/// - `chord_error`: straight moves and their blends stay near the smooth course
/// - `tilt`: the tool comes from above
/// - `tool_table`: tip and shaft stay above the table's plane
/// - `reach`: the arm reaches every pose on one branch, without a jump; if not, no other check of the arm is made
/// - `joint_limits`, `joint_speed`, `joint_acceleration`, `singularity`: of the arm's motion
/// - `tip_speed`: the tip's speed, computed from the joints, is the nominal one away from ends and changes of speed
/// - `table`: the links stay clear of the table's plane
/// - `self_collision`: the hulls of the arm's links and of the instrument stay clear of each other
/// - `base`: they stay clear of the base's column and of the shoulder
/// - `surface_collision` (with a surface): the arm's hulls, flange included, stay clear of the tissue
/// - `shaft` (with a surface, and unless the tool is only a needle): the shaft, straight from the needle's upper end to
///   the flange, stays clear of the tissue
/// - `needle` (with a surface): in the air the whole needle stays clear of the tissue; in the tissue, the part higher
///   than ProgramSettings::clearance_mm above the entry
///
/// The last five cover the whole motion, from the first approach to the end of the retreat. They also cover the time
/// between samples: their values are least distances, minus the distance that the hulls can move in half a period.
///
/// - `power` (if given): within the generator's usual range for cutting
/// - `registration_scale`, `registration_rmse`, `registration_inliers`, `registration_converged` (if given)
///
/// Forces, the switching of the electrode, cables, other objects in the room and the controller's accuracy are **not**
/// checked; `not_made` lists them, together with checks whose input is missing.
/// @throws InvalidArgument if the program has no cut, or if the intended path is in another frame than `path`.
[[nodiscard]] ProgramChecks check_program(const RobotProgram& program, const ToolPath& path,
                                          const CheckSettings& settings = {}, const CheckInputs& inputs = {});

/// The longest gap between neighbouring waypoints of a ring, and the limit of the check `gap`.
struct WaypointGap {
  double longest_mm = 0.0;
  double limit_mm = 0.0;
  std::size_t after = 0;  ///< index of the waypoint before the gap
};
/// Finds the longest gap; the path is taken as closed. @throws InvalidArgument without waypoints.
[[nodiscard]] WaypointGap widest_gap(const ToolPath& path, const CheckSettings& settings = {});

/// Returns the angle, degrees, between a tool's axis (unit, into the tissue, base frame) and straight down; see the
/// check `tilt`.
[[nodiscard]] double tilt_deg(const Vec3& axis);

/// Returns the names of all checks of check_program, in order.
[[nodiscard]] std::span<const char* const> check_names();

/// Returns whether a person may override a failed check of this name. False for `finite` and `frame` (the program would
/// be meaningless), for `reach` (there is no motion to write), for `margin` (a cut near the tumour is refused) and for
/// unknown names. To plan a smaller margin, set CheckSettings::close_margin_mm; the program's header states it.
[[nodiscard]] bool can_be_overridden(const std::string& check);

/// Marks failed checks of these names as overridden. @throws InvalidArgument for a name that cannot be overridden.
void override_checks(ProgramChecks& checks, const std::vector<std::string>& names);

}  // namespace incise
