#include "storage/kept_record.hpp"

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

constexpr const char* kScenarioRunSchema = "incise.scenario_run/1";

Json points_json(const Points& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back({p.x(), p.y(), p.z()});
  return list;
}

Points points_of(const JsonPlace& place, const char* key) {
  Points points;
  for (const Json& point : place.at(key, "a list of points")) {
    const bool is_point =
        point.is_array() && point.size() == 3 && point[0].is_number() && point[1].is_number() && point[2].is_number();
    if (!is_point) place.refuse(key, point.dump().substr(0, 40), "points of 3 numbers");
    points.emplace_back(point[0].get<double>(), point[1].get<double>(), point[2].get<double>());
  }
  return points;
}

Json errors_json(const std::optional<PathErrors>& errors) {
  if (!errors) return nullptr;
  return {{"places_mm", points_json(errors->places)},
          {"signed_error_mm", errors->signed_error_mm},
          {"lag_mm", errors->lag_mm},
          {"success", errors->is_success}};
}

std::optional<PathErrors> errors_from(const JsonPlace& file) {
  if (file.at("errors", "an object or null").is_null()) return std::nullopt;
  const JsonPlace place = file.inside("errors");
  PathErrors errors{points_of(place, "places_mm"), place.numbers("signed_error_mm"), place.number("lag_mm"),
                    place.flag("success")};
  if (errors.places.empty() || errors.places.size() != errors.signed_error_mm.size()) {
    place.refuse("signed_error_mm", fmt::format("{} of them", errors.signed_error_mm.size()),
                 fmt::format("one for each of {} places", errors.places.size()));
  }
  return errors;
}

Json residual_settings_json(const RobustSettings& settings) {
  return {{"sd_mm", settings.residual_sd_mm},
          {"length_mm", settings.residual_length_mm},
          {"common_sd_mm", settings.common_sd_mm},
          {"placement_sd_mm", settings.placement_sd_mm}};
}

}  // namespace

ScenarioRunFolder::ScenarioRunFolder(std::filesystem::path folder, std::string case_key)
    : folder_(std::move(folder)), case_key_(std::move(case_key)) {}

std::string ScenarioRunFolder::key_of(const RunSetting& setting, const ToolPath& path) const {
  ToolPath followed = path;
  followed.source_sha256.clear();  // where it lies counts, not what it was read from
  followed.specimen_id.clear();    // the case's key has it
  followed.is_virtual = false;     // likewise; a path is only marked once it is in a file
  return sha256_of_text(fmt::format("{} {} speed={} dullness={} stiffness={} path={}", kScenarioRunSchema, case_key_,
                                    setting.speed_mm_s, setting.dullness, setting.stiffness_of_case,
                                    to_json(followed)));
}

std::filesystem::path ScenarioRunFolder::file_of(const RunSetting& setting, const ToolPath& path) const {
  return KeptRecord(folder_, kScenarioRunSchema, key_of(setting, path)).file();
}

std::optional<ScenarioRun> ScenarioRunFolder::load(const RunSetting& setting, const ToolPath& path, Monitor& monitor) {
  return KeptRecord(folder_, kScenarioRunSchema, key_of(setting, path))
      .load(monitor, "The run is simulated anew", [&setting](const JsonPlace& file) {
        return ScenarioRun{setting, errors_from(file), file.text("problem")};
      });
}

void ScenarioRunFolder::save(const ScenarioRun& run, const ToolPath& path) {
  KeptRecord(folder_, kScenarioRunSchema, key_of(run.setting, path))
      .save({{"speed_mm_s", run.setting.speed_mm_s},
             {"dullness", run.setting.dullness},
             {"stiffness_of_case", run.setting.stiffness_of_case},
             {"problem", run.problem},
             {"errors", errors_json(run.errors)}});
}

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

void write_robust(FolderStore& store, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s) {
  const std::filesystem::path folder = store.root() / "robust";
  require_replaceable(folder);
  AtomicFolder target(folder);
  const RobustCompensation& chosen = robust.compensation;
  ToolPath path = chosen.path;
  path.specimen_id = store.specimen_id();
  path.is_virtual = store.case_file().settings.is_virtual;
  write_tool_path(target.path() / "path.json", path);
  write_contour_vtp(target.path() / "path.vtp", entry_contour(chosen.path));
  Json json = robust_summary_json(robust);
  json["calibration_sha256"] = sha256_of_file(calibration);
  json["corrected_offset_mm"] = robust.corrected_offset_mm;
  json["offset_mm"] = chosen.offset_mm;
  json["is_limited"] = chosen.is_limited;
  write_json(target.path() / "robust.json", json);
  store.write_manifest_to(target.path(), wall_s);
  target.commit();
}

}  // namespace incise
