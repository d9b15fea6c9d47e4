#include "json_values.hpp"
#include "kerf_files.hpp"

#include <incise/core/error.hpp>
#include <incise/io/verdict_json.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

Json zone_json(const std::optional<ErrorZone>& zone) {
  if (!zone) return nullptr;
  return {{"at_or_below_mm", zone->at_or_below_mm}, {"points", zone->points}, {"fraction", zone->fraction}};
}

/// Hour by hour; a sector that no point lies in says so by null.
Json clock_json(const std::vector<ClockSector>& sectors) {
  Json json = Json::array();
  for (const ClockSector& sector : sectors) {
    json.push_back({{"hour", sector.hour},
                    {"points", sector.points},
                    {"mean_mm", or_null(sector.mean_mm)},
                    {"min_mm", or_null(sector.min_mm)},
                    {"max_mm", or_null(sector.max_mm)}});
  }
  return json;
}

Json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

Json to_json(const Evaluation& e) {
  Json json;
  json["outcome"] = to_string(e.outcome);
  json["closed_loop"] = or_null(e.closed_loop);
  json["negative_margin"] = or_null(e.negative_margin);
  json["contour"] = to_string(e.contour);
  json["target_mm"] = e.target_mm;
  json["n_points"] = e.n_points;
  json["abs_error_mm"] =
      e.abs_error_mm ? Json{{"mean", e.abs_error_mm->mean}, {"sd", e.abs_error_mm->sd}, {"max", e.abs_error_mm->max}}
                     : Json(nullptr);
  json["signed_error_mm"] = e.signed_error_mm ? Json{{"mean", e.signed_error_mm->mean},
                                                     {"sd", e.signed_error_mm->sd},
                                                     {"min", e.signed_error_mm->min},
                                                     {"max", e.signed_error_mm->max}}
                                              : Json(nullptr);
  json["paper_abs_error_mm"] = or_null(e.paper_abs_error_mm);
  json["paper_success"] = or_null(e.paper_success);
  json["hu_score"] = or_null(e.hu_score);
  json["hu_score_ideal"] = or_null(e.hu_score_ideal);
  json["hu_score_seven"] = or_null(e.hu_score_seven);
  json["hu_seven_unstable"] = e.hu_seven_unstable;
  json["hu_unstable"] = e.hu_unstable;
  json["hu_excess"] = or_null(e.hu_excess);
  json["hu_score_to_ideal"] = or_null(e.hu_score_to_ideal);
  json["hu_ideal_unstable"] = e.hu_ideal_unstable;
  json["centroid_shift_mm"] = or_null(e.centroid_shift_mm);
  json["close_margin"] =
      e.close_margin ? Json{{"points", e.close_margin->points}, {"fraction", e.close_margin->fraction}} : Json(nullptr);
  json["zones"] = {{"positive_margin", zone_json(e.positive_zone)}, {"too_close", zone_json(e.too_close_zone)}};
  json["hausdorff_mm"] = e.hausdorff ? Json{{"symmetric", e.hausdorff->symmetric_mm()},
                                            {"from_incision", e.hausdorff->from_first_mm},
                                            {"from_ideal", e.hausdorff->from_second_mm}}
                                     : Json(nullptr);
  json["by_clock"] = clock_json(e.by_clock);
  json["coverage"] = e.coverage;
  if (e.start_gap_mm) json["start_gap_mm"] = *e.start_gap_mm;
  if (e.end_gap_mm) json["end_gap_mm"] = *e.end_gap_mm;
  return json;
}

Json to_json(const SimulatedCut& cut) {
  const IncisionResult& incision = cut.incision;
  Json json = to_json(cut.centerline);
  json["outcome"] = to_string(cut.outcome);
  json["closed_loop"] = or_null(incision.is_closed_loop);
  json["inner_edge"] = incision.is_closed_loop ? to_json(cut.inner_edge) : Json(nullptr);  // null: an open cut has none
  json["gap_mm"] = or_null(incision.gap_mm);
  json["gap_deg"] = incision.gap_deg;
  json["kerf_width_mm"] = incision.kerf_width_mm;
  add_kerf_json(json, cut);
  json["tets"] = cut.tets;
  json["removed_tets"] = incision.record.removals.size();
  json["removed_volume_mm3"] = incision.record.removed_volume_mm3();
  json["steps"] = incision.steps.size();
  json["solver_iterations"] = incision.solver_iterations;
  json["at_rest"] = incision.is_at_rest;
  json["unconverged_steps"] = incision.unconverged_steps;
  json["held_back_vertices"] = incision.held_back_vertices;
  json["inverted_tets"] = incision.inverted_tets;
  json["slipped_bonds"] = incision.slipped_bonds;
  json["peak_tool_force_mn"] = incision.peak_tool_force_mn;
  json["peak_tool_torque_mn_mm"] = incision.peak_tool_torque_mn_mm;
  json["thermal_half_width_mm"] = cut.thermal_half_width_mm;
  json["thermal_margin_mm"] = or_null(cut.thermal_margin_mm);
  json["verdict"] = to_json(cut.verdict);
  json["wall_s"] = incision.wall_s;
  json["ms_per_step"] =
      incision.steps.empty() ? 0.0 : 1e3 * incision.wall_s / static_cast<double>(incision.steps.size());
  return json;
}

Json to_json(const MeshQuality& q) {
  Json json;
  json["tets"] = q.tets;
  json["vertices"] = q.vertices;
  json["volume_mm3"] = q.volume_mm3;
  json["min_dihedral_deg"] = q.min_dihedral_deg;
  json["max_dihedral_deg"] = q.max_dihedral_deg;
  json["dihedral_histogram"] = {{"bin_width_deg", MeshQuality::kBinWidthDeg}, {"counts", q.dihedral_histogram}};
  json["min_radius_ratio"] = q.min_radius_ratio;
  json["mean_radius_ratio"] = q.mean_radius_ratio;
  json["smallest_tet_mm3"] = q.smallest_tet_mm3;
  json["edge_mm"] = {{"min", q.edges.min_mm}, {"mean", q.edges.mean_mm}, {"max", q.edges.max_mm}};
  return json;
}

Json to_json(const MeshingResult& m) {
  Json json = to_json(m.quality);
  json["meets_quality"] = m.meets_quality;
  json["meets_volume"] = m.meets_volume;
  json["meets_target"] = m.meets_target;
  json["label_volume_mm3"] = m.label_volume_mm3;
  json["relative_volume_error"] = m.relative_volume_error;
  json["fine_mm"] = m.fine_mm;
  json["coarse_mm"] = m.coarse_mm;
  json["dropped_bodies"] = m.dropped_bodies;
  json["wall_s"] = m.wall_s;
  return json;
}

Json to_json(const Segmentation& s) {
  Json json;
  json["voxels"] = s.voxels;
  json["volume_mm3"] = s.volume_mm3;
  json["occupancy_volume_mm3"] = s.occupancy_volume_mm3;
  json["tissue_hu"] = s.tissue_hu;
  json["components"] = s.components;
  json["holes_filled"] = s.holes_filled;
  json["cut_faces"] = s.cut_faces();
  json["smoothing_mm"] = s.smoothing_mm;
  json["verdict"] = to_json(s.verdict);
  return json;
}

Json to_json(const StaticResult& r) {
  Json json;
  json["outcome"] = to_string(r.outcome);
  json["converged"] = r.outcome == Outcome::Success;
  json["note"] = explain_stretch(r);
  json["iterations"] = r.iterations;
  json["load_steps"] = r.load_steps;
  json["relative_residual"] = std::isfinite(r.relative_residual) ? Json(r.relative_residual) : Json(nullptr);
  json["max_displacement_mm"] = r.max_displacement_mm;
  json["penetration_mm"] = r.penetration_mm;
  json["reaction_mn"] = Json::array();
  for (const Vec3& reaction : r.reactions_mn) json["reaction_mn"].push_back(vector_json(reaction));
  json["inverted_tets"] = r.inverted_tets;
  json["solver"] = r.solver;
  json["wall_s"] = r.wall_s;
  return json;
}

Json to_json(const Correction& correction) {
  const Compensation& c = correction.moves;
  Json json = correction_summary_json(correction);
  json["waypoints"] = c.path.waypoints.size();
  json["error_mm"] = c.error_mm;
  json["move_mm"] = c.move_mm;
  if (!correction.iteration) return json;
  const std::vector<CompensationPass>& passes = correction.iteration->passes;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    Json& pass = json["history"][k];
    pass["offset_mm"] = passes[k].offset_mm;
    pass["error_mm"] = passes[k].error_mm;
    pass["is_limited"] = passes[k].is_limited;
    pass["is_interpolated"] = passes[k].is_interpolated;
  }
  return json;
}

Json correction_summary_json(const Correction& correction) {
  const Compensation& c = correction.moves;
  Json json;
  json["method"] = to_string(correction.method);
  json["floor_mm"] = or_null(correction.floor_mm);
  json["max_move_mm"] = c.max_move_mm;
  json["limited_waypoints"] = c.limited_waypoints;
  json["interpolated_waypoints"] = c.interpolated_waypoints;
  if (!correction.iteration) return json;
  const ConvergedCompensation& iteration = *correction.iteration;
  json["compensation_outcome"] = to_string(iteration.outcome);
  json["simulations"] = iteration.passes.size();
  json["best_pass"] = iteration.best;
  json["contraction"] = or_null(iteration.contraction);
  json["history"] = Json::array();
  for (const CompensationPass& pass : iteration.passes) {
    json["history"].push_back({{"mean_abs_error_mm", or_null(pass.mean_abs_error_mm)},
                               {"max_abs_error_mm", or_null(pass.max_abs_error_mm)},
                               {"smooth_error_mm", or_null(pass.smooth_error_mm)},
                               {"lag_mm", pass.lag_mm},
                               {"max_move_mm", pass.max_move_mm},
                               {"limited_waypoints", std::count(pass.is_limited.begin(), pass.is_limited.end(), 1)},
                               {"shortfall_mm", pass.shortfall_mm},
                               {"open_layers", pass.open_layers},
                               {"verdict", to_string(pass.verdict)},
                               {"success", pass.is_success}});
  }
  return json;
}

Json plan_summary_json(const ToolPath& path) {
  Json json;
  json["length_mm"] = length_mm(entry_contour(path));
  json["waypoints"] = path.waypoints.size();
  json["duration_s"] = duration_s(path);
  json["closed"] = path.is_closed;
  return json;
}

Json to_json(const std::vector<StageReport>& stages) {
  Json json = Json::array();
  for (const StageReport& stage : stages) {
    json.push_back({{"name", to_string(stage.stage)}, {"state", to_string(stage.state)}, {"wall_s", stage.wall_s}});
  }
  return json;
}

Outcome read_outcome(const nlohmann::ordered_json& json, const char* key, const std::filesystem::path& file) {
  const auto found = json.find(key);  // the end where this is no object
  if (found == json.end() || !found->is_string()) throw DataError(file, key, "no text", "the name of an outcome");
  const auto name = found->get<std::string>();
  const std::optional<Outcome> outcome = value_of<Outcome>(name);
  if (!outcome) throw DataError(file, key, fmt::format("'{}'", name), "the name of an outcome");
  return *outcome;
}

}  // namespace incise
