#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/storage/robust_files.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

Json residual_settings_json(const RobustSettings& settings) {
  return {{"sd_mm", settings.residual_sd_mm},
          {"length_mm", settings.residual_length_mm},
          {"common_sd_mm", settings.common_sd_mm},
          {"placement_sd_mm", settings.placement_sd_mm}};
}

}  // namespace

Json to_json(const PathRisk& risk) {
  const bool is_measured = risk.unmeasured_weight < 1.0;
  return {{"expected_abs_error_mm", is_measured ? Json(risk.expected_abs_error_mm) : Json(nullptr)},
          {"p_close_margin", is_measured ? Json(risk.p_close_margin) : Json(nullptr)},
          {"unmeasured_weight", risk.unmeasured_weight}};
}

Json scenarios_json(const ScenarioSet& scenarios, const RobustSettings& settings) {
  Json json;
  json["reference_kpa"] = scenarios.reference_kpa;
  json["simulated_force_n"] = scenarios.simulated_force_n;
  json["own_stiffness_sd"] = scenarios.own_stiffness_sd;
  json["spread"] = {{"drag_length_sd_mm", scenarios.tissues.drag_length_sd_mm},
                    {"ln_stiffness_sd", scenarios.tissues.ln_stiffness_sd},
                    {"bias_sd_mm", scenarios.tissues.bias_sd_mm}};
  json["stiffness_shift_mm"] = {{"mean", scenarios.stiffness_shift_mm}, {"sd", scenarios.stiffness_shift_sd_mm}};
  json["residual"] = residual_settings_json(settings);
  json["tissues"] = Json::array();
  for (const TissueScenario& tissue : scenarios.tissues.points) {
    json["tissues"].push_back({{"weight", tissue.weight},
                               {"drag_length_mm", tissue.drag_length_mm},
                               {"stiffness_factor", tissue.stiffness_factor},
                               {"bias_mm", tissue.bias_mm}});
  }
  return json;
}

Json robust_summary_json(const RobustCorrection& robust) {
  const RobustCompensation& chosen = robust.compensation;
  Json json;
  json["outcome"] = to_string(chosen.outcome);
  json["max_probability"] = robust.settings.max_probability;
  json["close_margin_mm"] = robust.settings.region.close_margin_mm;
  json["contour"] = to_string(ContourKind::InnerEdge);
  json["intended"] = to_json(chosen.intended);
  json["corrected"] = to_json(chosen.corrected);
  json["robust"] = to_json(chosen.robust);
  json["simulations"] = chosen.simulations;
  json["scenarios"] = scenarios_json(robust.scenarios, robust.settings);
  return json;
}

void write_robust(RunFolder& run, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s) {
  const std::filesystem::path folder = run.root() / "robust";
  require_replaceable(folder);
  AtomicFolder target(folder);
  const RobustCompensation& chosen = robust.compensation;
  ToolPath path = chosen.path;
  path.specimen_id = run.specimen_id();
  path.is_virtual = run.case_file().settings.is_virtual;
  write_tool_path(target.path() / "path.json", path);
  write_contour_vtp(target.path() / "path.vtp", entry_contour(chosen.path));
  Json json = robust_summary_json(robust);
  json["calibration_sha256"] = sha256_of_file(calibration);
  json["corrected_offset_mm"] = robust.corrected_offset_mm;
  json["offset_mm"] = chosen.offset_mm;
  json["is_limited"] = chosen.is_limited;
  write_json(target.path() / "robust.json", json);
  run.write_manifest_to(target.path(), wall_s);
  target.commit();
}

}  // namespace incise
