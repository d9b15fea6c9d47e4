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
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Which line of the cut was measured.
enum class ContourKind {
  Centerline,  ///< mid-line of the kerf, as a simulation gives it; one lateral margin outside the tumour edge
  InnerEdge,   ///< border of the kerf next to the tumour, as a photograph shows it; closer by the electrode's radius
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
  v("contour", s.contour, "What was measured.");
  v({"lateral_margin_mm", "Intended, from the tumour edge to the kerf's mid-line.", "mm"}, s.lateral_margin_mm,
    kPositive);
  v({"electrode_radius_mm", "Half the kerf's width.", "mm"}, s.electrode_radius_mm, kNotNegative);
  v({"target_mm", "Intended distance of the measured contour; absent: 5.0 for a mid-line, 4.5 for an inner edge.",
     "mm"},
    s.target_mm, kPositive);
  v({"close_margin_mm", "Clinical cut-off of the tissue left beside the tumour (paper III-A.1, [30]).", "mm"},
    s.close_margin_mm, kPositive);
  v.direction("approach", s.approach, "Direction in which the camera looks.");
  v({"step_mm", "Spacing of the points at which errors are taken.", "mm"}, s.step_mm, kPositive);
  v("twelve_o_clock", s.twelve_o_clock,
    "12 o'clock of the clock face over the tumour; absent: up in the picture (view_along(approach).y).");
  v({"end_tolerance_mm", "An open cut is complete if it ends within this of the intended ends.", "mm"},
    s.end_tolerance_mm, kNotNegative);
}

/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const EvaluationSettings& settings);

/// Intended distance of the measured contour: as set, else the lateral margin, less the electrode radius for an inner
/// edge.
[[nodiscard]] double target_mm(const EvaluationSettings& settings);

struct CloseMargin {
  /// Points that leave no more than close_margin_mm of tissue beside the tumour edge, those inside it included.
  std::size_t points = 0;
  double fraction = 0.0;  ///< of all points, [0, 1]
};
inline void describe(Visitor& v, CloseMargin& m) {
  v("points", m.points, "How many leave too little tissue.");
  v("fraction", m.fraction, "Of all points.");
}

/// Points in one of the zones of the paper's Fig. 6. Borders are signed errors of the contour that was measured: -4.5
/// and -2.3 mm for an inner edge at 4.5 mm and a cut-off of 2.2 mm, and for a mid-line at 5.0 mm just the same.
struct ErrorZone {
  double at_or_below_mm = 0.0;  ///< upper border, which belongs to the zone
  std::size_t points = 0;
  double fraction = 0.0;  ///< of all points, [0, 1]
};
inline void describe(Visitor& v, ErrorZone& z) {
  v("at_or_below_mm", z.at_or_below_mm, "Upper border, which belongs to the zone.");
  v("points", z.points, "How many.");
  v("fraction", z.fraction, "Of all points.");
}

/// The measures of one incision (paper III-A.1, III-A.2; docs/models/measures.md). What could not be measured is
/// absent.
struct Evaluation {
  /// Success, PositiveMargin or OpenLoop (for an open cut: it does not reach both its ends).
  Outcome outcome = Outcome::OpenLoop;
  std::optional<bool> closed_loop;  ///< absent for an open cut
  /// Tissue is left all round the tumour edge, and a ring encloses it; absent: nothing to measure.
  std::optional<bool> negative_margin;
  ContourKind contour = ContourKind::Centerline;
  double target_mm = 0.0;  ///< 0 for an open cut: its errors are lateral offsets from the intended line
  std::size_t n_points = 0;
  std::optional<Summary> abs_error_mm;
  std::optional<Summary> signed_error_mm;
  /// Mean and greatest |distance − (lateral margin − electrode radius)|: the paper's figure, which takes 4.5 whatever
  /// was measured.
  std::optional<double> paper_abs_error_mm;
  std::optional<double> paper_max_abs_error_mm;
  std::optional<bool> paper_success;  ///< closed, and paper_max_abs_error_mm within lateral margin − electrode radius
  std::optional<double> hu_score;     ///< tumour edge against incision, as OpenCV's I1; needs a closed contour
  std::optional<double> hu_score_ideal;  ///< what the edge's perfect offset by target_mm would score
  std::optional<double> hu_score_seven;
  bool hu_seven_unstable = false;  ///< see HuScore::seven_is_unstable; of edge and incision
  bool hu_unstable = false;        ///< see HuScore::is_unstable; of edge and incision
  /// hu_score − hu_score_ideal: what the score holds against the cut, and not against the shape of the tumour. May be
  /// negative: the score is no distance to the ideal.
  std::optional<double> hu_excess;
  /// The ideal offset against the incision, as OpenCV's I1: 0 for a perfect cut, whatever the tumour's shape.
  std::optional<double> hu_score_to_ideal;
  bool hu_ideal_unstable = false;           ///< of edge and ideal offset, on which hu_excess and hu_score_to_ideal rest
  std::optional<double> centroid_shift_mm;  ///< between the centres of the two filled regions, in the picture plane
  std::optional<CloseMargin> close_margin;
  std::optional<ErrorZone> positive_zone;   ///< no tissue left beside the tumour edge; of a ring
  std::optional<ErrorZone> too_close_zone;  ///< some, but no more than close_margin_mm; of a ring
  /// The incision (first) against the perfect offset of the edge (second), of an open cut against the intended line.
  std::optional<HausdorffDistance> hausdorff;
  /// [0, 1]: share of directions from the tumour's centre that meet the incision; of an open cut: share of the line.
  double coverage = 0.0;
  std::optional<double> start_gap_mm;  ///< open cut: by how much it falls short of the line's start (0: reaches it)
  std::optional<double> end_gap_mm;    ///< open cut: the same at the line's end
  ContourErrors errors;                ///< point by point, in the order of the incision
  std::vector<double> clock_h;         ///< of each of these points, see clock_hours; empty for an open cut
  std::vector<ClockSector> by_clock;   ///< hours 1 … 12; empty for an open cut and where nothing was measured
};
void describe(Visitor& v, Evaluation& evaluation);

/// Measures a ring-shaped incision against the tumour edge that it was to keep clear of.
/// @param incision    as measured, mm; absent when none was found (then only the outcome, open_loop, is given); a
/// contour that is
///                    not closed is an open ring.
/// @param tumor_edge  closed, at least 3 points, mm, same frame and configuration as the incision.
/// @throws InvalidArgument with every violation of the settings; for contours that are too short or not finite.
/// @note Margins are of tissue: for a mid-line half the kerf's width is taken off the distance, so a mid-line at 2.7 mm
/// and an inner edge at 2.2 mm are equally close. Seconds at most; O(points · edge points).
[[nodiscard]] Evaluation evaluate(const std::optional<Contour>& incision, const Contour& tumor_edge,
                                  const EvaluationSettings& settings = {});

/// Measures an open cut against the line it was to follow: lateral offset, positive = to the left of the line's
/// direction seen against the approach. Points beyond the line's ends count as overshoot and are left out of the
/// errors. Depth is not seen by contours.
/// @param incision  as measured, mm, open; absent when none was found.
/// @param line      the intended course, open, at least 2 points, mm, same frame.
[[nodiscard]] Evaluation evaluate_line(const std::optional<Contour>& incision, const Contour& line,
                                       const EvaluationSettings& settings = {});

}  // namespace incise
