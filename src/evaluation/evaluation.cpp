#include <incise/core/expect.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/evaluation/hu.hpp>
#include <incise/evaluation/level_loop.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace incise {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Gaps between segments up to this angle, rad, are only rounding.
constexpr double kSeam = 1e-9;

std::vector<Vec2> flat_points(const Contour& contour, const Vec3& approach) {
  const ViewFrame view = view_along(approach);
  std::vector<Vec2> flat;
  for (const Vec3& p : contour.points) flat.push_back(view.to_view(p).head<2>());
  if (contour.is_closed && !flat.empty()) flat.push_back(flat.front());
  return flat;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether c and d lie on different sides of the line through a and b, or on it.
bool parts(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) <= 0.0;
}

/// Returns the share of directions from `center` (picture's x and y, mm) that meet the contour, [0, 1]; exact for
/// polylines.
double angular_coverage(const Contour& contour, const Vec2& center, const Vec3& approach) {
  const std::vector<Vec2> flat = flat_points(contour, approach);
  std::vector<std::pair<double, double>> spans;  // within [0, 2π]
  for (std::size_t i = 0; i + 1 < flat.size(); ++i) {
    const Vec2 a = flat[i] - center;
    const Vec2 b = flat[i + 1] - center;
    const double turn = std::atan2(cross(a, b), a.dot(b));  // the short way from a to b
    double low = std::atan2(a.y(), a.x()) + std::min(0.0, turn);
    if (low < 0.0) low += kTurn;
    const double high = low + std::abs(turn);
    spans.emplace_back(low, std::min(high, kTurn));
    if (high > kTurn) spans.emplace_back(0.0, high - kTurn);
  }
  std::sort(spans.begin(), spans.end());
  double gaps = 0.0;
  double end = 0.0;
  const auto pass_to = [&](double low) {
    if (low - end > kSeam) gaps += low - end;
  };
  for (const auto& [low, high] : spans) {
    pass_to(low);
    end = std::max(end, high);
  }
  pass_to(kTurn);
  return 1.0 - gaps / kTurn;
}

/// Returns whether the contours meet, seen along the approach. O(points of a · points of b).
bool meet_in_view(const Contour& a, const Contour& b, const Vec3& approach) {
  const std::vector<Vec2> p = flat_points(a, approach);
  const std::vector<Vec2> q = flat_points(b, approach);
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    for (std::size_t j = 0; j + 1 < q.size(); ++j) {
      const bool are_apart = (p[i].cwiseMax(p[i + 1]).array() < q[j].cwiseMin(q[j + 1]).array()).any() ||
                             (q[j].cwiseMax(q[j + 1]).array() < p[i].cwiseMin(p[i + 1]).array()).any();
      if (!are_apart && parts(p[i], p[i + 1], q[j], q[j + 1]) && parts(q[j], q[j + 1], p[i], p[i + 1])) return true;
    }
  }
  return false;
}

std::vector<double> magnitudes(const std::vector<double>& values, double reference = 0.0) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const double value : values) result.push_back(std::abs(value - reference));
  return result;
}

/// Tissue that half the kerf's width removes on the tumour's side of the measured contour.
double kerf_allowance_mm(const EvaluationSettings& settings) {
  return settings.contour == ContourKind::Centerline ? settings.electrode_radius_mm : 0.0;
}

/// Least distance between the contour and the tumour edge. Two polylines that do not meet are nearest at a corner of
/// one of them.
double least_distance_mm(const Contour& incision, const Contour& edge, const std::vector<double>& signed_distances) {
  double least = *std::min_element(signed_distances.begin(), signed_distances.end());
  for (const Vec3& p : incision.points) least = std::min(least, nearest_on(edge, p).distance_mm);
  for (const Vec3& p : edge.points) least = std::min(least, nearest_on(incision, p).distance_mm);
  return least;
}

void measure_errors(const EvaluationSettings& settings, Evaluation& result) {
  const std::vector<double>& distances = result.errors.signed_distance_mm;
  const double allowance = kerf_allowance_mm(settings);
  CloseMargin close;
  for (const double distance : distances) {
    if (distance - allowance <= settings.close_margin_mm) ++close.points;
  }
  const auto count = static_cast<double>(distances.size());
  close.fraction = static_cast<double>(close.points) / count;
  result.close_margin = close;
  const auto reached = static_cast<std::size_t>(
      std::count_if(distances.begin(), distances.end(), [&](double distance) { return distance <= allowance; }));
  result.positive_zone = ErrorZone{.at_or_below_mm = allowance - result.target_mm,
                                   .points = reached,
                                   .fraction = static_cast<double>(reached) / count};
  result.too_close_zone = ErrorZone{.at_or_below_mm = settings.close_margin_mm + allowance - result.target_mm,
                                    .points = close.points - reached,
                                    .fraction = static_cast<double>(close.points - reached) / count};
  result.n_points = distances.size();
  result.signed_error_mm = summarize(result.errors.signed_error_mm);
  result.abs_error_mm = summarize(magnitudes(result.errors.signed_error_mm));

  const double paper_target = settings.lateral_margin_mm - settings.electrode_radius_mm;
  const Summary paper = summarize(magnitudes(distances, paper_target));
  result.paper_abs_error_mm = paper.mean;
  result.paper_max_abs_error_mm = paper.max;
  result.paper_success = result.closed_loop.value() && paper.max <= paper_target;
}

/// Measures errors by clock position.
void measure_clock(const Vec2& center, const EvaluationSettings& settings, Evaluation& result) {
  const ViewFrame view = view_along(settings.approach);
  const Vec3 middle = view.from_view({center.x(), center.y(), 0.0});
  result.clock_h =
      clock_hours(result.errors.points.points, middle, settings.approach, settings.twelve_o_clock.value_or(view.y));
  const auto sectors = errors_by_clock(result.clock_h, result.errors.signed_error_mm);
  result.by_clock.assign(sectors.begin(), sectors.end());
}

void measure_shape(const Contour& incision, const Contour& edge, const EvaluationSettings& settings,
                   Evaluation& result) {
  const FilledMoments edge_moments = filled_moments(edge, settings.approach);
  const Contour ideal = outer_offset(edge, result.target_mm, settings.approach);
  const FilledMoments ideal_moments = filled_moments(ideal, settings.approach);
  const HuScore floor = hu_score(edge_moments.hu, ideal_moments.hu);
  result.hu_score_ideal = floor.opencv;
  result.hu_ideal_unstable = floor.is_unstable;
  if (incision.points.size() >= 2) {
    result.hausdorff = hausdorff_distance(incision, ideal, settings.approach, settings.step_mm);
  }
  if (!incision.is_closed || signed_area_mm2(incision, settings.approach) == 0.0) return;
  const FilledMoments incision_moments = filled_moments(incision, settings.approach);
  const HuScore score = hu_score(edge_moments.hu, incision_moments.hu);
  result.hu_score = score.opencv;
  result.hu_score_seven = score.seven;
  result.hu_seven_unstable = score.seven_is_unstable;
  result.hu_unstable = score.is_unstable;
  if (score.opencv && floor.opencv) result.hu_excess = *score.opencv - *floor.opencv;
  result.hu_score_to_ideal = hu_score(ideal_moments.hu, incision_moments.hu).opencv;
  result.centroid_shift_mm = (incision_moments.centroid_mm - edge_moments.centroid_mm).norm();
}

}  // namespace

double target_mm(const EvaluationSettings& settings) {
  if (settings.target_mm) return *settings.target_mm;
  const double allowance = settings.contour == ContourKind::InnerEdge ? settings.electrode_radius_mm : 0.0;
  return settings.lateral_margin_mm - allowance;
}

std::vector<Problem> validate(const EvaluationSettings& s) {
  std::vector<Problem> violations = problems_of(s);
  const Expect expect(violations);
  expect(s.lateral_margin_mm > s.electrode_radius_mm, "lateral_margin_mm", s.lateral_margin_mm,
         "more than the electrode's radius");
  if (s.twelve_o_clock) {
    const double across = s.twelve_o_clock->cross(s.approach).norm();
    expect(across > 1e-6 * s.approach.norm() * s.twelve_o_clock->norm(), "twelve_o_clock", across,
           "a direction across the approach");
  }
  return violations;
}

Evaluation evaluate(const std::optional<Contour>& incision, const Contour& tumor_edge,
                    const EvaluationSettings& settings) {
  require_none(validate(settings));
  Evaluation result;
  result.contour = settings.contour;
  result.target_mm = target_mm(settings);
  result.closed_loop = incision.has_value() && incision->is_closed;
  result.outcome = Outcome::OpenLoop;
  if (!incision) {
    // The score of a perfect cut needs only the edge.
    measure_shape(Contour{.points = {}, .is_closed = false}, tumor_edge, settings, result);
    return result;
  }

  result.errors = contour_errors(*incision, tumor_edge, result.target_mm, settings.approach, settings.step_mm);
  measure_errors(settings, result);
  measure_shape(*incision, tumor_edge, settings, result);
  const Vec2 center = filled_moments(tumor_edge, settings.approach).centroid_mm;
  result.coverage = angular_coverage(*incision, center, settings.approach);
  measure_clock(center, settings, result);

  const double least = least_distance_mm(*incision, tumor_edge, result.errors.signed_distance_mm);
  const bool is_clear = least > kerf_allowance_mm(settings) && !meet_in_view(*incision, tumor_edge, settings.approach);
  // A closed ring beside the tumour is clear of it, too, but leaves it in the patient. If the two do not meet, one
  // point of the edge shows whether the ring encloses it.
  const bool is_around = !incision->is_closed || contains_in_view(*incision, tumor_edge.points[0], settings.approach);
  result.negative_margin = is_clear && is_around;
  if (*result.closed_loop) result.outcome = *result.negative_margin ? Outcome::Success : Outcome::PositiveMargin;
  return result;
}

void describe(Visitor& v, Evaluation& e) {
  v("outcome", e.outcome, "How the cut ended.");
  v("closed_loop", e.closed_loop, "Whether the ring closed; absent for an open cut.");
  v("negative_margin", e.negative_margin, "Whether tissue is left all round the tumour edge.");
  v("contour", e.contour, "Which line of the cut was measured.");
  v({"target_mm", "Intended distance of that line from the tumour edge.", "mm"}, e.target_mm);
  v("n_points", e.n_points, "Number of points at which errors were taken.");
  v({"abs_error_mm", "Absolute error, |error|.", "mm"}, e.abs_error_mm);
  v({"signed_error_mm", "Signed error; positive: farther from the tumour than intended.", "mm"}, e.signed_error_mm);
  v({"paper_abs_error_mm", "Mean |error| as the paper defines it.", "mm"}, e.paper_abs_error_mm);
  v({"paper_max_abs_error_mm", "Greatest |error| as the paper defines it.", "mm"}, e.paper_max_abs_error_mm);
  v("paper_success", e.paper_success, "Success in the paper's sense.");
  v("hu_score", e.hu_score, "Hu score of tumour edge and incision, as OpenCV's I1.");
  v("hu_score_ideal", e.hu_score_ideal, "hu_score of a perfect offset of the tumour edge.");
  v("hu_score_seven", e.hu_score_seven, "Hu score with all seven invariants.");
  v("hu_seven_unstable", e.hu_seven_unstable, "Whether hu_score_seven depends on rounding.");
  v("hu_unstable", e.hu_unstable, "Whether hu_score depends on rounding.");
  v("hu_excess", e.hu_excess, "hu_score minus hu_score_ideal.");
  v("hu_score_to_ideal", e.hu_score_to_ideal, "Hu score of ideal offset and incision; 0 for a perfect cut.");
  v("hu_ideal_unstable", e.hu_ideal_unstable, "Whether hu_excess and hu_score_to_ideal depend on rounding.");
  v({"centroid_shift_mm", "Distance between the centres of the two filled regions.", "mm"}, e.centroid_shift_mm);
  v("close_margin", e.close_margin, "Points that leave too little tissue beside the tumour edge.");
  v.begin({"zones", "Points in the zones of the paper's Fig. 6."});
  v("positive_margin", e.positive_zone, "Points with no tissue left beside the tumour edge.");
  v("too_close", e.too_close_zone, "Points with some tissue left, but no more than the close margin.");
  v.end();
  v({"hausdorff_mm", "Hausdorff distance between the incision and the ideal line.", "mm"}, e.hausdorff);
  v("by_clock", e.by_clock, "Signed errors by hour of the clock face.");
  v("coverage", e.coverage, "Share of directions from the tumour's centre that meet the incision.");
  v({"start_gap_mm", "Length by which an open cut falls short of the line's start.", "mm"}, e.start_gap_mm);
  v({"end_gap_mm", "Length by which an open cut falls short of the line's end.", "mm"}, e.end_gap_mm);
  v.bulk("errors", e.errors, "Errors point by point.");
  v.bulk("clock_h", e.clock_h, "Clock position of each of these points.");
}

}  // namespace incise
