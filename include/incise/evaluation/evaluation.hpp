#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/outcome.hpp>
#include <incise/core/problem.hpp>
#include <incise/evaluation/clock.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/evaluation/hausdorff.hpp>
#include <incise/evaluation/statistics.hpp>

#include <optional>
#include <string_view>
#include <vector>

namespace incise {

/// The line of the cut that was measured.
enum class ContourKind {
  Centerline,  ///< mid-line of the kerf, from a simulation; intended one lateral margin outside the tumour edge
  InnerEdge,   ///< edge of the kerf next to the tumour, from a photograph; closer by the electrode's radius
};
inline constexpr std::array<std::string_view, 2> kContourKindNames{"centerline", "inner_edge"};
[[nodiscard]] constexpr Names names_of(ContourKind) {
  return kContourKindNames;
}

struct EvaluationSettings {
  ContourKind contour = ContourKind::Centerline;
  double lateral_margin_mm = kLateralMarginMm;
  double electrode_radius_mm = kElectrodeRadiusMm;
  std::optional<double> target_mm = std::nullopt;
  double close_margin_mm = kCloseMarginMm;
  Vec3 approach = -Vec3::UnitZ();
  double step_mm = 0.25;
  std::optional<Vec3> twelve_o_clock = std::nullopt;
  double end_tolerance_mm = 1.0;
};
inline void describe(Visitor& v, EvaluationSettings& s) {
  v("contour", s.contour, "Line of the cut that is measured.");
  v({"lateral_margin_mm", "Planned distance from the tumour edge to the kerf's mid-line.", "mm"}, s.lateral_margin_mm,
    kPositive);
  v({"electrode_radius_mm", "Radius of the electrode: half the kerf's width.", "mm"}, s.electrode_radius_mm,
    kNotNegative);
  v({"target_mm", "Intended distance of the measured contour; absent: 5.0 for a mid-line, 4.5 for an inner edge.",
     "mm"},
    s.target_mm, kPositive);
  v({"close_margin_mm", "Clinical cut-off for the tissue left beside the tumour (paper III-A.1, [30]).", "mm"},
    s.close_margin_mm, kPositive);
  v.direction("approach", s.approach, "Direction in which the camera looks.");
  v({"step_mm", "Spacing of the points at which errors are taken.", "mm"}, s.step_mm, kPositive);
  v("twelve_o_clock", s.twelve_o_clock,
    "Direction of 12 o'clock on the clock face over the tumour; absent: up in the picture (view_along(approach).y).");
  v({"end_tolerance_mm", "An open cut is complete if it ends within this distance of the intended ends.", "mm"},
    s.end_tolerance_mm, kNotNegative);
}

/// Returns every violation; empty if valid.
[[nodiscard]] std::vector<Problem> validate(const EvaluationSettings& settings);

/// Returns the intended distance of the measured contour, mm: EvaluationSettings::target_mm if set, otherwise the
/// lateral margin, for an inner edge minus the electrode radius.
[[nodiscard]] double target_mm(const EvaluationSettings& settings);

/// Points of a contour that lie too close to the tumour edge.
struct CloseMargin {
  /// Points with at most close_margin_mm of tissue between cut and tumour edge, including points inside the edge.
  std::size_t points = 0;
  double fraction = 0.0;  ///< of all points, [0, 1]
};
inline void describe(Visitor& v, CloseMargin& m) {
  v("points", m.points, "Number of points that leave too little tissue.");
  v("fraction", m.fraction, "Fraction of all points.");
}

/// Points in one of the zones of the paper's Fig. 6. Borders are signed errors of the measured contour: -4.5 and -2.3
/// mm for an inner edge at 4.5 mm and a cut-off of 2.2 mm, and the same for a mid-line at 5.0 mm.
struct ErrorZone {
  double at_or_below_mm = 0.0;  ///< upper border, which belongs to the zone
  std::size_t points = 0;
  double fraction = 0.0;  ///< of all points, [0, 1]
};
inline void describe(Visitor& v, ErrorZone& z) {
  v("at_or_below_mm", z.at_or_below_mm, "Upper border of the zone, which belongs to it.");
  v("points", z.points, "Number of points in the zone.");
  v("fraction", z.fraction, "Fraction of all points.");
}

/// The measures of one incision (paper III-A.1, III-A.2; docs/models/measures.md). A measure that could not be taken is
/// absent.
struct Evaluation {
  /// Success, PositiveMargin or OpenLoop (an open cut: it does not reach both ends of the line).
  Outcome outcome = Outcome::OpenLoop;
  std::optional<bool> closed_loop;  ///< absent for an open cut
  /// Whether tissue remains all round the tumour edge and the ring, if closed, encloses the edge; absent for an open
  /// cut, and without an incision.
  std::optional<bool> negative_margin;
  ContourKind contour = ContourKind::Centerline;
  double target_mm = 0.0;  ///< 0 for an open cut: its errors are lateral offsets from the intended line
  std::size_t n_points = 0;
  std::optional<Summary> abs_error_mm;
  std::optional<Summary> signed_error_mm;
  /// Mean and greatest |distance − (lateral margin − electrode radius)|: the paper's measure, with 4.5 mm for any
  /// contour.
  std::optional<double> paper_abs_error_mm;
  std::optional<double> paper_max_abs_error_mm;
  std::optional<bool> paper_success;  ///< closed, and paper_max_abs_error_mm within lateral margin − electrode radius
  std::optional<double> hu_score;     ///< of tumour edge and incision, OpenCV's I1; needs a closed contour
  std::optional<double> hu_score_ideal;  ///< hu_score of a perfect offset of the edge by target_mm
  std::optional<double> hu_score_seven;  ///< see HuScore::seven; of edge and incision
  bool hu_seven_unstable = false;  ///< see HuScore::seven_is_unstable; of edge and incision
  bool hu_unstable = false;        ///< see HuScore::is_unstable; of edge and incision
  /// hu_score − hu_score_ideal: the part of the score that is due to the cut, not to the shape of the tumour. May be
  /// negative, because the score is not a distance from the ideal.
  std::optional<double> hu_excess;
  /// Score of ideal offset and incision, OpenCV's I1: 0 for a perfect cut round a tumour of any shape.
  std::optional<double> hu_score_to_ideal;
  bool hu_ideal_unstable = false;           ///< of edge and ideal offset, on which hu_excess and hu_score_to_ideal rest
  std::optional<double> centroid_shift_mm;  ///< between the centres of the two filled regions, in the picture plane
  std::optional<CloseMargin> close_margin;
  std::optional<ErrorZone> positive_zone;   ///< no tissue remains beside the tumour edge; only for a ring
  std::optional<ErrorZone> too_close_zone;  ///< some, but at most close_margin_mm; only for a ring
  /// From the incision (first) to the ideal offset of the edge (second); for an open cut, to the intended line.
  std::optional<HausdorffDistance> hausdorff;
  /// [0, 1]: share of directions from the tumour's centre that meet the incision; for an open cut, share of the line.
  double coverage = 0.0;
  std::optional<double> start_gap_mm;  ///< open cut: missing length at the line's start; 0 if the cut reaches it
  std::optional<double> end_gap_mm;    ///< open cut: the same at the line's end
  ContourErrors errors;                ///< point by point, in the order of the incision
  std::vector<double> clock_h;         ///< clock position of each of these points; empty for an open cut
  std::vector<ClockSector> by_clock;   ///< hours 1 … 12; empty for an open cut, and if nothing was measured
};
void describe(Visitor& v, Evaluation& evaluation);

/// Measures a ring-shaped incision against the tumour edge.
/// @param incision    as measured, mm; an open contour is a ring that did not close. Absent if no incision was found:
///   then the outcome is OpenLoop, and only hu_score_ideal is measured.
/// @param tumor_edge  closed, at least 3 points, mm, same frame and configuration as the incision.
/// @throws InvalidArgument with every violation of the settings; for contours that are too short or not finite.
/// @note Margins are of tissue: for a mid-line, half the kerf's width is subtracted from the distance, so a mid-line at
/// 2.7 mm and an inner edge at 2.2 mm are equally close. Takes seconds at most; O(points · edge points).
[[nodiscard]] Evaluation evaluate(const std::optional<Contour>& incision, const Contour& tumor_edge,
                                  const EvaluationSettings& settings = {});

/// Measures an open cut against the intended line. Errors are lateral offsets, mm, positive = to the left of the line's
/// direction, as the camera sees it. Points beyond the line's ends are overshoot and do not count as errors. Contours
/// do not show depth.
/// @param incision  as measured, mm, open; absent if none was found.
/// @param line      the intended line, open, at least 2 different points, mm, same frame.
/// @throws InvalidArgument with every violation of the settings; for contours that are closed, too short or not finite.
[[nodiscard]] Evaluation evaluate_line(const std::optional<Contour>& incision, const Contour& line,
                                       const EvaluationSettings& settings = {});

}  // namespace incise
