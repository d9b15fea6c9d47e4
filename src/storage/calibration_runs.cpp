#include "storage/json_place.hpp"
#include "storage/json_values.hpp"
#include "storage/kept_record.hpp"

#include <incise/io/manifest.hpp>
#include <incise/storage/calibration_file.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <array>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRunSchema = "incise.calibration_run/2";
constexpr std::array<double Summary::*, 4> kSummaryParts{&Summary::mean, &Summary::sd, &Summary::min, &Summary::max};
constexpr std::array<const char*, 4> kSummaryNames{"mean", "sd", "min", "max"};

std::optional<Summary> summary_of(const JsonPlace& file, const char* key) {
  if (file.at(key, "an object or null").is_null()) return std::nullopt;
  const JsonPlace place = file.inside(key);
  Summary summary;
  for (std::size_t i = 0; i < kSummaryParts.size(); ++i) summary.*kSummaryParts[i] = place.number(kSummaryNames[i]);
  return summary;
}

std::optional<Contour> contour_or_null(const JsonPlace& file, const char* key) {
  if (file.at(key, "an object or null").is_null()) return std::nullopt;
  return contour_of(file.inside(key));
}

Json ring_json(const std::optional<ClosedRing>& ring) {
  if (!ring) return nullptr;
  return {
      {"depth_mm", ring->depth_mm}, {"half_width_mm", ring->half_width_mm}, {"midline", contour_json(ring->midline)}};
}

std::optional<ClosedRing> ring_of(const JsonPlace& file, const char* key) {
  if (file.at(key, "an object or null").is_null()) return std::nullopt;
  const JsonPlace place = file.inside(key);
  return ClosedRing{place.number("depth_mm"), place.number("half_width_mm"), contour_of(place.inside("midline"))};
}

Json run_json(const CalibrationRun& run) {
  Json json;
  json["speed_mm_s"] = run.setting.speed_mm_s;
  json["dullness"] = run.setting.dullness;
  json["stiffness_of_case"] = run.setting.stiffness_of_case;
  json["reference_step_s"] = run.reference_step_s;
  json["outcome"] = to_string(run.outcome);
  json["problem"] = run.problem;
  json["closed_loop"] = run.closed_loop;
  json["paper_success"] = run.paper_success;
  json["signed_error_mm"] = summary_json(run.signed_error_mm);
  json["paper_abs_error_mm"] = summary_json(run.paper_abs_error_mm);
  json["inner_signed_error_mm"] = summary_json(run.inner_signed_error_mm);
  json["inner_abs_error_mm"] = summary_json(run.inner_abs_error_mm);
  json["tets"] = run.tets;
  json["wall_s"] = run.wall_s;
  json["inner_edge"] = run.inner_edge ? contour_json(*run.inner_edge) : Json(nullptr);
  json["final_tumor_edge"] = run.final_tumor_edge.points.empty() ? Json(nullptr) : contour_json(run.final_tumor_edge);
  json["ring"] = ring_json(run.ring);
  return json;
}

CalibrationRun run_from(const JsonPlace& file, const RunSetting& setting) {
  CalibrationRun run;
  run.setting = setting;
  run.reference_step_s = file.number("reference_step_s");
  run.outcome = read_outcome(file.object, "outcome", file.path);
  run.problem = file.text("problem");
  run.closed_loop = file.flag("closed_loop");
  run.paper_success = file.flag("paper_success");
  run.signed_error_mm = summary_of(file, "signed_error_mm");
  run.paper_abs_error_mm = summary_of(file, "paper_abs_error_mm");
  run.inner_signed_error_mm = summary_of(file, "inner_signed_error_mm");
  run.inner_abs_error_mm = summary_of(file, "inner_abs_error_mm");
  run.tets = static_cast<std::size_t>(file.number("tets"));
  run.wall_s = file.number("wall_s");
  run.inner_edge = contour_or_null(file, "inner_edge");
  run.final_tumor_edge = contour_or_null(file, "final_tumor_edge").value_or(Contour{});
  run.ring = ring_of(file, "ring");
  return run;
}

}  // namespace

RunFolder::RunFolder(std::filesystem::path folder, std::vector<std::string> specimen_keys)
    : folder_(std::move(folder)), specimen_keys_(std::move(specimen_keys)) {}

std::string RunFolder::key_of(std::size_t specimen, const RunSetting& setting) const {
  return sha256_of_text(fmt::format("{} {} speed={} dullness={} stiffness={}", kRunSchema, specimen_keys_.at(specimen),
                                    setting.speed_mm_s, setting.dullness, setting.stiffness_of_case));
}

std::filesystem::path RunFolder::file_of(std::size_t specimen, const RunSetting& setting) const {
  return KeptRecord(folder_, kRunSchema, key_of(specimen, setting)).file();
}

std::optional<CalibrationRun> RunFolder::load(std::size_t specimen, const RunSetting& setting, Monitor& monitor) {
  return KeptRecord(folder_, kRunSchema, key_of(specimen, setting))
      .load(monitor, "The run is simulated anew",
            [&setting](const JsonPlace& file) { return run_from(file, setting); });
}

void RunFolder::save(std::size_t specimen, const CalibrationRun& run) {
  KeptRecord(folder_, kRunSchema, key_of(specimen, run.setting)).save(run_json(run));
  ++saved_;
}

}  // namespace incise
