#include <incise/workflow/study.hpp>

namespace incise {
namespace {

EvaluationSettings evaluation_settings(const Case& settings, ContourKind contour) {
  EvaluationSettings evaluation;
  evaluation.contour = contour;
  evaluation.lateral_margin_mm = settings.plan.lateral_margin_mm;
  evaluation.electrode_radius_mm = settings.needle.radius_mm();
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
  cut.outcome = cut.incision.outcome == Outcome::Success ? cut.centerline.outcome : cut.incision.outcome;
  return cut;
}

SimulatedCut cut_and_judge(const Case& settings, const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                           const ToolPath& intended, Workers& workers, Monitor& monitor, std::optional<IncisionProgress> from,
                           const ProgressKeeper& keep) {
  IncisionSettings incision;
  incision.cut = settings.cut;
  incision.needle = settings.needle;
  incision.approach = settings.plan.approach.normalized();
  incision.frames = settings.frames;
  ToolPath with_edge = path;
  with_edge.tumor_edge = intended.tumor_edge;
  if (!from) from = begin_incision(model, stretched, with_edge, incision);
  return judge(settings, continue_incision(model, stretched, with_edge, incision, std::move(*from), workers, monitor, keep), intended,
               model.mesh.tets.size());
}

}  // namespace incise
