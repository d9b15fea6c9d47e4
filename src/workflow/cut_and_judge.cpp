#include "workflow/layer_line.hpp"

#include <incise/cutting/path_heat.hpp>
#include <incise/workflow/cut_verdict.hpp>
#include <incise/workflow/study.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// A layer of the kerf and its errors.
struct JudgedLayer {
  KerfLayer layer;
  LayerErrors errors;
};
void describe(Visitor& v, JudgedLayer& l) {
  describe(v, l.layer);
  describe(v, l.errors);
}

std::vector<JudgedLayer> judged_layers(const SimulatedCut& cut) {
  const std::vector<KerfLayer>& layers = cut.incision.kerf.layers;
  std::vector<JudgedLayer> judged;
  for (std::size_t i = 0; i < layers.size(); ++i) judged.push_back({layers[i], cut.layers.at(i)});
  return judged;
}

std::optional<std::string> why_no_deep_margin(const SimulatedCut& cut) {
  if (cut.incision.kerf.deep_margin) return std::nullopt;
  if (cut.incision.kerf.body.surface.triangles.empty()) return "nothing was cut";
  return "the case names no tumor.surface: an edge does not show how deep the tumour is";
}

EvaluationSettings evaluation_settings(const Case& settings, ContourKind contour) {
  return {.contour = contour,
          .lateral_margin_mm = settings.plan.lateral_margin_mm,
          .electrode_radius_mm = radius_mm(settings.tool),
          .close_margin_mm = settings.close_margin_mm,
          .approach = settings.plan.approach};
}

/// Returns a layer's mid-line, lifted to the skin's height. @pre the layer has one.
Contour lifted_midline(const Case& settings, const KerfLayer& layer) {
  Contour lifted = *layer.centerline;
  for (Vec3& p : lifted.points) p -= layer.depth_mm * settings.plan.approach.normalized();
  return lifted;
}

/// Errors of a layer's mid-line against the same line as the mid-line on the skin, seen along the approach, at the
/// skin's height.
LayerErrors layer_errors(const Case& settings, const KerfLayer& layer, const ToolPath& intended, const EvaluationSettings& centerline) {
  LayerErrors errors;
  if (!layer.centerline) return errors;
  if (settings.plan.kind == PlanKind::Line) {
    const Evaluation line = evaluate_line(lifted_midline(settings, layer), entry_contour(intended), centerline);
    return {line.signed_error_mm, line.abs_error_mm};
  }
  std::vector<double> values = layer_line_errors(settings, layer, intended.tumor_edge).signed_error_mm;
  errors.signed_error_mm = summarize(values);
  for (double& value : values) value = std::abs(value);
  errors.abs_error_mm = summarize(values);
  return errors;
}

/// Mean of a field over the waypoints of a path.
double mean_of(const ToolPath& path, double Waypoint::*field) {
  double sum = 0.0;
  for (const Waypoint& waypoint : path.waypoints) sum += waypoint.*field;
  return sum / static_cast<double>(path.waypoints.size());
}

/// Adds layers every millimetre below the default ones, down to the path's deepest place.
void add_layers_down_to(const ToolPath& path, const Vec3& approach, std::vector<double>& layer_depths_mm) {
  double deepest_mm = 0.0;
  for (const Waypoint& waypoint : path.waypoints) deepest_mm = std::max(deepest_mm, waypoint.depth_mm * waypoint.axis.dot(approach));
  while (layer_depths_mm.back() + 1.0 <= deepest_mm) layer_depths_mm.push_back(layer_depths_mm.back() + 1.0);
}

/// Least distance of an open cut's mid-lines from the tumour's edge, seen along the approach; below 0 within the edge.
std::optional<double> line_to_edge_mm(const IncisionResult& incision, const Contour& edge, const Vec3& approach) {
  if (edge.points.empty()) return std::nullopt;
  std::vector<const Contour*> lines;
  if (incision.centerline) lines.push_back(&*incision.centerline);
  for (const KerfLayer& layer : incision.kerf.layers) {
    if (layer.centerline) lines.push_back(&*layer.centerline);
  }
  const ViewFrame view = view_along(approach);
  const Contour polygon = flat_in_view(edge, view);
  constexpr double kStepMm = 0.1;
  std::optional<double> least;
  for (const Contour* line : lines) {
    if (line->points.size() < 2) continue;
    for (const Vec3& p : resample_by_step(flat_in_view(*line, view), kStepMm).points) {
      const double distance =
          nearest_on(polygon, p).distance_mm * (contains_in_view(polygon, p, -Vec3::UnitZ()) ? -1.0 : 1.0);
      if (!least || distance < *least) least = distance;
    }
  }
  return least;
}

}  // namespace

ContourErrors layer_line_errors(const Case& settings, const KerfLayer& layer, const Contour& tumor_edge) {
  const EvaluationSettings centerline = evaluation_settings(settings, ContourKind::Centerline);
  return contour_errors(lifted_midline(settings, layer), tumor_edge, centerline.lateral_margin_mm, centerline.approach,
                        centerline.step_mm);
}

SimulatedCut judge(const Case& settings, IncisionResult incision, const ToolPath& followed, const ToolPath& intended,
                   std::size_t tets) {
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
  for (const KerfLayer& layer : cut.incision.kerf.layers) cut.layers.push_back(layer_errors(settings, layer, intended, centerline));
  // Heat comes from the real tool, which moves at the speeds of the path, whatever the speed of the simulated tool.
  cut.thermal_half_width_mm = widest_heat(settings.thermal, settings.plan.power_w, followed, settings.tool).half_width_mm;
  if (settings.plan.kind == PlanKind::Ring && cut.centerline.signed_error_mm) {
    cut.thermal_margin_mm = cut.centerline.target_mm + cut.centerline.signed_error_mm->min - cut.thermal_half_width_mm;
  }
  if (settings.plan.kind == PlanKind::Line) {
    cut.line_to_edge_mm = line_to_edge_mm(cut.incision, intended.tumor_edge, settings.plan.approach);
    if (cut.line_to_edge_mm) cut.thermal_margin_mm = *cut.line_to_edge_mm - cut.thermal_half_width_mm;
  }
  cut.outcome = cut.incision.outcome == Outcome::Success ? cut.centerline.outcome : cut.incision.outcome;
  cut.verdict = verdict_of_cut(settings, cut);
  return cut;
}

IncisionSettings incision_settings(const Case& settings, const ToolPath& path) {
  IncisionSettings incision;
  incision.cut = settings.cut;
  incision.cut.power_w = settings.plan.power_w;
  incision.cut.real_speed_mm_s = mean_of(path, &Waypoint::speed_mm_s);
  incision.cut.depth_mm = mean_of(path, &Waypoint::depth_mm);
  if (is_viscous(settings.material)) incision.time_since_stretch_s = settings.time_since_stretch_s;
  incision.tool = settings.tool;
  incision.approach = settings.plan.approach.normalized();
  incision.frames = settings.frames;
  return incision;
}

IncisionSettings incision_settings_for(const Case& settings, const ToolPath& path, const TriMesh& tumor_surface) {
  IncisionSettings incision = incision_settings(settings, path);
  incision.tumor_surface = tumor_surface;
  add_layers_down_to(path, incision.approach, incision.layer_depths_mm);
  return incision;
}

SimulatedCut cut_and_judge(const Case& settings, const TissueModel& model, const TissueState& stretched,
                           const ToolPath& path, const ToolPath& intended, Workers& workers, Monitor& monitor) {
  ToolPath with_edge = path;
  with_edge.tumor_edge = intended.tumor_edge;
  IncisionResult incision =
      simulate_incision(model, stretched, with_edge, incision_settings_for(settings, path, {}), workers, monitor);
  return judge(settings, std::move(incision), path, intended, model.mesh.tets.size());
}

void describe(Visitor& v, SimulatedCut& cut) {
  describe(v, cut.centerline);
  describe(v, cut.incision);
  v("outcome", cut.outcome, "Outcome of incision and margin together.");
  v.bulk("inner_edge_evaluation", cut.inner_edge, "Inner edge against margin less electrode radius, tool out.");
  v.derived("inner_edge", cut.incision.is_closed_loop ? std::optional(cut.inner_edge) : std::nullopt,
            "Errors of a ring's inner edge; an open cut has none.");
  v.bulk("layer_errors", cut.layers, "Errors of the mid-line of each layer.");
  v.derived("layers", judged_layers(cut), "Measures, layer by layer.");
  v.derived("deep_margin_unknown", why_no_deep_margin(cut), "Why there is no deep margin.");
  v("tets", cut.tets, "Number of tets of the mesh before the cut.");
  v({"thermal_half_width_mm", "How far beside the electrode heat damages tissue.", "mm"}, cut.thermal_half_width_mm);
  v({"thermal_margin_mm", "Tissue left unheated beside the tumour edge.", "mm"}, cut.thermal_margin_mm);
  v({"line_to_edge_mm", "Least distance of an open cut from the tumour's edge.", "mm"}, cut.line_to_edge_mm);
  v("verdict", cut.verdict, "Objections to the path that was cut.");
}

}  // namespace incise
