#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/tool_path.hpp>

#include <optional>
#include <string_view>
#include <vector>

namespace incise {

enum class PlanKind {
  Ring,  ///< closed, around a tumour edge
  Line,  ///< open, along a drawn curve
};
inline constexpr std::array<std::string_view, 2> kPlanKindNames{"ring", "line"};
[[nodiscard]] constexpr Names names_of(PlanKind) {
  return kPlanKindNames;
}

/// How the tool is held at a waypoint.
enum class AxisMode {
  Approach,       ///< along the approach everywhere, as in the paper
  SurfaceNormal,  ///< against the surface's normal, averaged over 2 mm
};
inline constexpr std::array<std::string_view, 2> kAxisModeNames{"approach", "surface_normal"};
[[nodiscard]] constexpr Names names_of(AxisMode) {
  return kAxisModeNames;
}

/// The intended incision. Defaults are the paper's (II-B.4).
struct PlanSettings {
  PlanKind kind = PlanKind::Ring;
  double lateral_margin_mm = kLateralMarginMm;  ///< from the tumour edge to the kerf's mid-line, > 0
  double depth_mm = kPlannedDepthMm;            ///< of the tool's tip below the surface, along its axis, > 0
  double speed_mm_s = 7.0;         ///< of the real tool, > 0
  double power_w = 35.0;           ///< electrosurgical, > 0
  Vec3 approach = -Vec3::UnitZ();  ///< into the tissue, as camera and surgeon look; non-zero
  /// A ring starts at its waypoint farthest along this, a line at that end (anterior in LPS); not along the approach.
  Vec3 start_direction = -Vec3::UnitY();
  int waypoints = 48;  ///< evenly spaced by arc length; at least 8 for a ring, 2 for a line
  AxisMode axis_mode = AxisMode::Approach;
  double rim_clearance_mm = 1.0;  ///< the path keeps this far from where the surface ends in the picture, >= 0
};
/// Describes the first field; a case file adds the drawn curve beside it.
inline void describe_kind(Visitor& v, PlanSettings& s) {
  v("kind", s.kind, "A ring around the tumour edge, or an open cut along a drawn curve.");
}
/// Describes all other fields.
inline void describe_course(Visitor& v, PlanSettings& s) {
  v({"lateral_margin_mm", "Distance from the tumour edge to the kerf's mid-line.", "mm"}, s.lateral_margin_mm,
    {0.5, 50.0});
  v({"depth_mm", "Depth of the tool's tip below the surface.", "mm"}, s.depth_mm, {0.5, 50.0});
  v({"speed_mm_s", "Speed of the real tool.", "mm/s"}, s.speed_mm_s, {0.1, 50.0});
  v({"power_w",
     "Electrosurgical power. With speed and depth, it determines how fast contact cuts (cut.power_exponent) and how "
     "far beside the cut heat reaches.",
     "W"},
    s.power_w, {0.0, 120.0, true});
  v.direction("approach", s.approach, "Direction into the tissue, in which camera and surgeon look.");
  v.direction("start_direction", s.start_direction,
              "A ring starts at its waypoint farthest along this direction; the start decides where the error falls.");
  v("waypoints", s.waypoints, "Number of waypoints, evenly spaced along the path.", {2.0, 2000.0});
  v("tool_axis", s.axis_mode, "How the tool is held at a waypoint.");
  v.internal("rim_clearance_mm", s.rim_clearance_mm,
             "Least distance of the path from where the surface ends in the picture.", kNotNegative);
}
inline void describe(Visitor& v, PlanSettings& s) {
  describe_kind(v, s);
  describe_course(v, s);
}

/// Returns every violation; empty if the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const PlanSettings& settings);

/// Projects a drawn tumour edge onto the surface along the approach. The order of the points is kept; segments longer
/// than 1 mm are subdivided to follow the surface.
/// @param edge          mm, same frame as the surface; treated as closed.
/// @param tolerance_mm  farthest that a drawn point may lie above or below the surface. Points between them may lie
/// farther by the length of their segment.
/// @throws CaseError naming the first point that misses the surface or lies farther off ("tumour edge off the
/// surface"), or if the contour has too few points, has no length or area, is longer than 10 m, is not finite or
/// crosses itself.
[[nodiscard]] Contour project_tumor_edge(const Contour& edge, const SurfaceQuery& surface, const Vec3& approach,
                                         double tolerance_mm = 5.0);
/// Projects the drawn curve of an open cut in the same way; treated as open.
[[nodiscard]] Contour project_line(const Contour& line, const SurfaceQuery& surface, const Vec3& approach,
                                   double tolerance_mm = 5.0);

/// Plans the ring at one lateral margin outside the tumour edge, on the surface.
/// The margin is the straight distance in space to the edge's segments, as in every evaluation here. On a surface of
/// curvature radius R it is shorter than the distance along the surface by about margin³ / (24 R²): 0.006 mm for 5 mm
/// and R = 30 mm. Each waypoint keeps the margin within 0.01 mm. The tool runs straight between waypoints, which brings
/// it closer by spacing² / (8 R_path): 0.03 mm for 2 mm and 15 mm.
/// @param surface     closed skin of the tissue in the configuration that is cut, mm.
/// @param tumor_edge  closed, on the surface (see project_tumor_edge), mm.
/// @returns a path in frame sim_stretched, counter-clockwise seen along the approach, which starts where the settings
/// say and encloses the edge.
/// @throws InvalidArgument listing every violation of the settings; CaseError for "a path outside the tissue" (beyond
/// or within rim_clearance_mm of the surface's rim, or over a fold) and for "a depth through the tissue", naming
/// waypoint and thickness. Source: [Paper, II-C.5], which does not say how it offsets; see docs/models/planning.md.
[[nodiscard]] ToolPath plan_ring(const SurfaceQuery& surface, const Contour& tumor_edge, const PlanSettings& settings);

/// Plans the open cut along a curve on the surface, mm; it starts at the end farther along start_direction. @throws as
/// plan_ring.
[[nodiscard]] ToolPath plan_line(const SurfaceQuery& surface, const Contour& line, const PlanSettings& settings);

/// Checks that a path can be cut into this tissue, whatever its origin.
/// @param rim_clearance_mm  >= 0.
/// @throws CaseError naming the first waypoint concerned, for: fewer than 8 (open: 2) waypoints, numbers that are not
/// finite, a depth or speed not above 0, an axis that is not unit or does not point into the tissue, a waypoint more
/// than 2 mm off the surface or within rim_clearance_mm of its rim, a depth through the tissue, a surface that is not
/// closed, a path that crosses itself, seen along the approach.
void check_path(const ToolPath& path, const SurfaceQuery& surface, const Vec3& approach, double rim_clearance_mm = 1.0);

/// Returns the thickness of the tissue under a point of the surface, mm: along unit `axis` from there to the first
/// exit. nullopt: no exit (the surface is not closed).
[[nodiscard]] std::optional<double> thickness_mm(const SurfaceQuery& surface, const Vec3& point, const Vec3& axis);

}  // namespace incise
