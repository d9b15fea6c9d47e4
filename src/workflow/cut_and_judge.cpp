#include <incise/workflow/study.hpp>

namespace incise {
namespace {

EvaluationSettings evaluation_settings(const Case& settings, ContourKind contour) {
  EvaluationSettings evaluation;
  evaluation.contour = contour;
  evaluation.lateral_margin_mm = settings.plan.lateral_margin_mm;
  evaluation.electrode_radius_mm = radius_mm(settings.tool);
  evaluation.close_margin_mm = settings.close_margin_mm;
  evaluation.approach = settings.plan.approach;
  return evaluation;
}

}  // namespace

SimulatedCut judge(const Case& settings, IncisionResult incision, const ToolPath& intended, std::size_t tets) {
  SimulatedCut cut;
  cut.incision = std::move(incision);
  cut.tets = tets;
  const EvaluationSettings centerline = evaluation_settings(settings, ContourKind::Centerline);
  const EvaluationSettings inner_edge = evaluation_settings(settings, ContourKind::InnerEdge);
  if (settings.plan.kind == PlanKind::Line) {
    cut.centerline = evaluate_line(cut.incision.centerline, entry_contour(intended), centerline);
  } else {
    cut.centerline = evaluate(cut.incision.centerline, intended.tumor_edge, centerline);
    cut.inner_edge = evaluate(cut.incision.inner_edge, cut.incision.final_tumor_edge, inner_edge);
  }
  // Heat is that of the real tool, whatever speed the simulated one needed.
  cut.thermal_half_width_mm =
      thermal_half_width_mm(settings.thermal, settings.plan.power_w, settings.plan.speed_mm_s, settings.plan.depth_mm);
  if (settings.plan.kind == PlanKind::Ring && cut.centerline.signed_error_mm) {
    cut.thermal_margin_mm = cut.centerline.target_mm + cut.centerline.signed_error_mm->min - cut.thermal_half_width_mm;
  }
  cut.outcome = cut.incision.outcome == Outcome::Success ? cut.centerline.outcome : cut.incision.outcome;
  return cut;
}

SimulatedCut cut_and_judge(const Case& settings, const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                           const ToolPath& intended, Workers& workers, Monitor& monitor) {
  IncisionSettings incision;
  incision.cut = settings.cut;
  incision.cut.power_w = settings.plan.power_w;
  incision.tool = settings.tool;
  incision.approach = settings.plan.approach.normalized();
  incision.frames = settings.frames;
  ToolPath with_edge = path;
  with_edge.tumor_edge = intended.tumor_edge;
  return judge(settings, simulate_incision(model, stretched, with_edge, incision, workers, monitor), intended,
               model.mesh.tets.size());
}

}  // namespace incise
