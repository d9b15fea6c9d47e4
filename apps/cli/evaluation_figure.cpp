#include "evaluation_figure.hpp"

namespace incise::cli {

std::string evaluation_figure_svg(const Evaluation& evaluation, const Contour& tumor_edge,
                                  const EvaluationSettings& settings, const std::string& name, ErrorColors colors) {
  ReportIncision incision;
  incision.name = name;
  incision.outcome = evaluation.outcome;
  incision.closed_loop = evaluation.closed_loop;
  incision.negative_margin = evaluation.negative_margin;
  incision.mean_abs_error_mm = evaluation.abs_error_mm->mean;
  incision.target_mm = evaluation.target_mm;
  incision.close_margin_mm = settings.close_margin_mm;
  incision.kerf_allowance_mm = settings.contour == ContourKind::Centerline ? settings.electrode_radius_mm : 0.0;
  incision.measured_contour = settings.contour == ContourKind::Centerline ? "kerf mid-line" : "kerf's inner edge";
  incision.tumor_edge = tumor_edge;
  incision.incision = evaluation.errors.points;
  incision.signed_error_mm = evaluation.errors.signed_error_mm;
  return contour_figure_svg(incision, {.colors = colors, .approach = settings.approach});
}

}  // namespace incise::cli
