#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/planning/plan_path.hpp>

#include <cstdint>
#include <vector>

namespace incise {

struct CompensationSettings {
  double target_mm = 5.0;
  double relaxation = 1.0;
  int smoothing_passes = 0;
  double close_margin_mm = kCloseMarginMm;
  double electrode_radius_mm = kElectrodeRadiusMm;
  Vec3 approach = -Vec3::UnitZ();
  AxisMode axis_mode = AxisMode::Approach;
  double step_mm = 0.25;
  double rim_clearance_mm = 1.0;
};
inline void describe(Visitor& v, CompensationSettings& s) {
  v({"target_mm", "Intended distance of the measured contour from the edge; 5 for a mid-line.", "mm"}, s.target_mm,
    kPositive);
  v("relaxation", s.relaxation, "Share of the measured error that is corrected; the paper: all of it.",
    {0.0, 1.0, true});
  v("smoothing_passes", s.smoothing_passes,
    "Number of passes that smooth the waypoints' errors with weights [1 2 1]/4; the paper: none.", kNotNegative);
  v({"close_margin_mm", "No waypoint moves to where less tissue than this remains beside the tumour edge.", "mm"},
    s.close_margin_mm, kPositive);
  v({"electrode_radius_mm", "Radius of the tool.", "mm"}, s.electrode_radius_mm, kNotNegative);
  v.direction("approach", s.approach, "Direction into the tissue.");
  v("tool_axis", s.axis_mode, "How the tool is held at a waypoint.");
  v({"step_mm", "Spacing of the points at which the measured contour's error is taken.", "mm"}, s.step_mm, kPositive);
  v({"rim_clearance_mm", "The corrected path keeps this far from the surface's rim.", "mm"}, s.rim_clearance_mm,
    kNotNegative);
}

/// A corrected path, and the move of each waypoint.
struct Compensation {
  ToolPath path;
  std::vector<double> error_mm;  ///< per waypoint: signed error measured there, after smoothing; negative = too close
  std::vector<double> move_mm;   ///< per waypoint: distance moved, positive = away from the tumour
  /// Per waypoint: 1 where close_margin_mm or the surface's rim cut the move short.
  std::vector<std::uint8_t> is_limited;
  /// Per waypoint: 1 where no measured point lay in its sector; its error is interpolated from its neighbours.
  std::vector<std::uint8_t> is_interpolated;
  std::size_t limited_waypoints = 0;
  std::size_t interpolated_waypoints = 0;
  double max_move_mm = 0.0;  ///< greatest |move|
};
inline void describe(Visitor& v, Compensation& c) {
  v.bulk("path", c.path, "The corrected path.");
  v.derived("waypoints", c.path.waypoints.size(), "Number of waypoints.");
  v("error_mm", c.error_mm, "Signed error measured at each waypoint.");
  v("move_mm", c.move_mm, "Move of each waypoint; positive: away from the tumour.");
  v.bulk("is_limited", c.is_limited, "For each waypoint: whether its move was cut short.");
  v.bulk("is_interpolated", c.is_interpolated, "For each waypoint: whether nothing was measured there.");
  v("limited_waypoints", c.limited_waypoints, "Number of waypoints whose move was cut short.");
  v("interpolated_waypoints", c.interpolated_waypoints, "Number of waypoints where nothing was measured.");
  v("max_move_mm", c.max_move_mm, "Greatest move of a waypoint.");
}

/// Sets the fields that follow from the lists: limited_waypoints, interpolated_waypoints and max_move_mm.
void count_moves(Compensation& compensation);

/// Corrects a path by the paper's rule: each waypoint moves away from, or towards, the tumour's centre by the error
/// that was measured in its direction. The error of a waypoint is the mean signed error (see contour_errors) of the
/// measured points whose polar angle about the tumour's centre, seen along the approach, is nearer to the waypoint's
/// angle than to its neighbours'. The waypoint moves radially in the picture and stays on the surface; the straight
/// distance in space between its old and new place equals relaxation · |error|, unless the move is limited. Depth,
/// speed, order and start do not change.
/// @param current   closed path that was cut (in simulation), on the surface.
/// @param measured  mid-line (or inner edge) of that cut, mm, same frame. It may be open: gaps are interpolated.
/// @param tumor_edge  closed, mm, same frame.
/// @throws InvalidArgument listing every violation of the settings, or for an open path or no measured point; CaseError
/// if the path does not run once round the tumour's centre in order of angle (the rule is then undefined), or if the
/// current or the corrected path fails check_path. Source: [Paper, II-C.5]; departs from it: the target of a mid-line
/// is 5.0 mm instead of 4.5, see docs/models/compensation.md.
[[nodiscard]] Compensation compensate_paper(const ToolPath& current, const Contour& measured, const Contour& tumor_edge,
                                            const SurfaceQuery& surface, const CompensationSettings& settings = {});

}  // namespace incise
