#include "storage/json_place.hpp"
#include "storage/json_values.hpp"

#include <incise/io/json_text.hpp>
#include <incise/io/verdict_json.hpp>
#include <incise/mechanics/material.hpp>
#include <incise/storage/calibration_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCalibrationSchema = "incise.calibration/1";
constexpr const char* kCalibrationHint = "Write the file with `incise calibrate`";
constexpr double kWeightTolerance = 1e-6;

// Beyond these no tissue, tool or photograph is: a number out of them was not measured or fitted.
struct Bounds {
  double low, high;
};
constexpr Bounds kLengthMm{1e-9, 1e3};    // above 0: a spread, a drag, a residual
constexpr Bounds kErrorMm{-1e3, 1e3};     // signed
constexpr Bounds kSpeedMmS{0.01, 100.0};  // as cut.speed_mm_s
constexpr Bounds kDullness{1e-6, 1e3};    // as cut.dullness
constexpr Bounds kStepS{1e-6, 1.0};       // as cut.reference_step_s
constexpr Bounds kRatio{1e-3, 1e3};       // of two stiffnesses, or of two lengths
constexpr Bounds kForceN{1e-6, 1e6};      // of a pull
constexpr Bounds kModulusKpa{kLeastYoungsModulusKpa, kMostYoungsModulusKpa};
constexpr Bounds kBiasMm{-10.0, 10.0};  // as compensation.bias_mm
constexpr Bounds kWeight{1e-300, 1.0 + kWeightTolerance};
constexpr Bounds kAngleDeg{1e-6, 1e5};
constexpr Bounds kPlaces{1e-6, 1e6};

Json setting_json(const RunSetting& setting, double reference_step_s) {
  return {{"speed_mm_s", setting.speed_mm_s},
          {"dullness", setting.dullness},
          {"drag_length_mm", setting.speed_mm_s * setting.dullness * reference_step_s},
          {"stiffness_of_case", setting.stiffness_of_case}};
}

Json run_summary_json(const CalibrationRun& run, const std::string& name) {
  Json json{{"name", name}, {"outcome", to_string(run.outcome)}, {"failure", run.is_failure()}};
  if (!run.problem.empty()) json["problem"] = run.problem;
  json["stiffness_of_case"] = run.setting.stiffness_of_case;
  json["mean_abs_mm"] = run.paper_abs_error_mm ? Json(run.paper_abs_error_mm->mean) : Json(nullptr);
  json["sd_abs_mm"] = run.paper_abs_error_mm ? Json(run.paper_abs_error_mm->sd) : Json(nullptr);
  json["max_abs_mm"] = run.paper_abs_error_mm ? Json(run.paper_abs_error_mm->max) : Json(nullptr);
  json["mean_signed_mm"] = run.signed_error_mm ? Json(run.signed_error_mm->mean) : Json(nullptr);
  json["mean_inner_signed_mm"] = run.inner_signed_error_mm ? Json(run.inner_signed_error_mm->mean) : Json(nullptr);
  json["tets"] = run.tets;
  json["wall_s"] = run.wall_s;
  return json;
}

Json rows_json(const Calibration& calibration) {
  Json rows = Json::array();
  for (const ScoreRow& row : calibration.table.rows) {
    Json json = setting_json(row.setting, calibration.reference_step_s);
    json.erase("stiffness_of_case");  // each specimen has its own
    json["failure"] = row.is_failure;
    json["mean_abs_mm"] = or_null(row.mean_abs_mm);
    json["sd_abs_mm"] = or_null(row.sd_abs_mm);
    json["max_abs_mm"] = or_null(row.max_abs_mm);
    json["mean_signed_mm"] = or_null(row.mean_signed_mm);
    json["mean_inner_signed_mm"] = or_null(row.mean_inner_signed_mm);
    json["score_percent"] = row.percent;
    json["inner_edge_score_percent"] = or_null(row.inner_percent);
    json["inner_edge_specimens"] = row.inner_specimens;
    json["specimens"] = Json::array();
    for (const CalibratedSpecimen& specimen : calibration.specimens) {
      json["specimens"].push_back(run_summary_json(specimen.runs[row.run], specimen.name));
    }
    rows.push_back(std::move(json));
  }
  return rows;
}

Json registration_quality_json(const std::optional<RegistrationQuality>& registration) {
  if (!registration) return nullptr;
  return {{"rmse_mm", registration->rmse_mm}, {"scale", registration->scale}};
}

Json specimen_json(const CalibratedSpecimen& s) {
  return {{"name", s.name},
          {"photographed_mean_abs_mm", s.photographed.mean_mm},
          {"photographed_max_abs_mm", s.photographed.max_mm},
          {"photographed_mean_signed_mm", s.signed_mean_mm},
          {"youngs_modulus_kpa", s.youngs_modulus_kpa},
          {"stretch_force_n", or_null(s.stretch_force_n)},
          {"simulated_force_n", s.simulated_force_n},
          {"stretch_mm", s.stretch_mm},
          {"registration", registration_quality_json(s.registration)},
          {"picture_turn_deg", s.picture.turn_deg},
          {"picture_rms_mm", s.picture.rms_mm},
          {"read_by_midline", s.read_by_midline}};
}

Json estimate_json(const ParameterEstimate& e, const ParameterVerdict& verdict) {
  return {{"mean", e.mean},
          {"sd", e.sd},
          {"low", e.low},
          {"high", e.high},
          {"prior_sd", e.prior_sd},
          {"told", to_string(verdict.told)},
          {"tied_to", verdict.tied_to.empty() ? Json(nullptr) : Json(verdict.tied_to)},
          {"at_limit", verdict.is_at_limit},
          {"grid", e.grid},
          {"density", e.density}};
}

Json posterior_json(const DragFit& fit, const Identifiability& told) {
  Json json;
  json["drag_length_mm"] = estimate_json(fit.drag_length_mm, told.parameters[0]);
  json["ln_stiffness_factor"] = estimate_json(fit.ln_stiffness, told.parameters[1]);
  json["bias_mm"] = estimate_json(fit.bias_mm, told.parameters[2]);
  json["stiffness_varied"] = fit.knows_stiffness;
  json["correlation"] = Json::array();
  for (int i = 0; i < 3; ++i)
    json["correlation"].push_back({fit.correlation(i, 0), fit.correlation(i, 1), fit.correlation(i, 2)});
  json["samples"] = Json::array();
  for (const PosteriorSample& s : fit.samples) {
    json["samples"].push_back({{"weight", s.weight},
                               {"drag_length_mm", s.drag_length_mm},
                               {"stiffness_factor", s.stiffness_factor},
                               {"bias_mm", s.bias_mm}});
  }
  return json;
}

Json fitted_json(const DragFit& fit) {
  Json list = Json::array();
  for (const SpecimenFit& s : fit.specimens) {
    list.push_back({{"name", s.name},
                    {"rms_mm", s.rms_mm},
                    {"check_rms_mm", or_null(s.check_rms_mm)},
                    {"observed_mm", s.observed_mm},
                    {"fitted_mm", s.fitted_mm},
                    {"simulated_mm", s.simulated_mm}});
  }
  return list;
}

double within(const JsonPlace& place, const char* key, const Bounds& bounds) {
  return place.number_between(key, bounds.low, bounds.high);
}

/// Calibrations of before registrations were kept have no such key.
std::optional<RegistrationQuality> registration_quality_from(const JsonPlace& specimen) {
  if (!specimen.has("registration") || specimen.at("registration", "an object or null").is_null()) return std::nullopt;
  const JsonPlace place = specimen.inside("registration");
  return RegistrationQuality{within(place, "rmse_mm", kLengthMm), within(place, "scale", kRatio)};
}

CalibratedSpecimenRecord specimen_from(const JsonPlace& place) {
  CalibratedSpecimenRecord record;
  record.name = place.text("name");
  record.youngs_modulus_kpa = within(place, "youngs_modulus_kpa", kModulusKpa);
  record.simulated_force_n = within(place, "simulated_force_n", {0.0, kForceN.high});
  if (!place.at("stretch_force_n", "a number or null").is_null())
    record.stretch_force_n = within(place, "stretch_force_n", kForceN);
  if (place.has("photographed_mean_signed_mm"))
    record.signed_error_mm = within(place, "photographed_mean_signed_mm", kErrorMm);
  if (place.has("stretch_mm")) record.stretch_mm = within(place, "stretch_mm", {0.0, kLengthMm.high});
  record.registration = registration_quality_from(place);
  return record;
}

std::vector<PosteriorSample> samples_from(const JsonPlace& posterior) {
  std::vector<PosteriorSample> samples;
  double sum = 0.0;
  for (const JsonPlace& place : posterior.objects("samples")) {
    samples.push_back({within(place, "weight", kWeight), within(place, "drag_length_mm", kLengthMm),
                       within(place, "stiffness_factor", kRatio), within(place, "bias_mm", kBiasMm)});
    sum += samples.back().weight;
  }
  if (samples.empty() || std::abs(sum - 1.0) > kWeightTolerance) {
    posterior.refuse("samples", fmt::format("weights that add up to {}", sum), "weights that add up to 1");
  }
  return samples;
}

/// Mean over the ring of photographed less fitted signed error.
double difference_from(const JsonPlace& fitted) {
  constexpr double kFarthestMm = 1e3;
  const std::vector<double> observed = fitted.numbers("observed_mm"), fit = fitted.numbers("fitted_mm");
  if (observed.empty() || fit.size() != observed.size()) {
    fitted.refuse("fitted_mm", fmt::format("{} numbers", fit.size()),
                  fmt::format("as many as observed_mm, {}, and at least one", observed.size()));
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < observed.size(); ++i) sum += observed[i] - fit[i];
  const double mean = sum / static_cast<double>(observed.size());
  if (!(std::abs(mean) < kFarthestMm))
    fitted.refuse("observed_mm", fmt::format("{:.3g} mm off in the mean", mean), "millimetres");
  return mean;
}

/// By how much each photograph differs from its fit. Calibrations whose fit is not written have none.
void read_differences(const JsonPlace& file, CalibrationRecord& record) {
  if (!file.has("fitted")) return;
  const std::vector<JsonPlace> fitted = file.objects("fitted");
  if (fitted.empty()) return;
  if (fitted.size() != record.specimens.size()) {
    file.refuse("fitted", fmt::format("{} specimens", fitted.size()),
                fmt::format("{}, one for each of specimens", record.specimens.size()));
  }
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    CalibratedSpecimenRecord& specimen = record.specimens[i];
    if (fitted[i].text("name") != specimen.name)
      fitted[i].refuse("name", fitted[i].text("name"), specimen.name + ", as in specimens");
    specimen.difference_mm = difference_from(fitted[i]);
  }
}

/// Nothing where a specimen's pull or fit is not known.
std::optional<StiffnessTrend> trend_of(const CalibrationRecord& record) {
  std::vector<StiffnessReading> readings;
  for (const CalibratedSpecimenRecord& specimen : record.specimens) {
    if (!specimen.stretch_force_n || !specimen.difference_mm) return std::nullopt;
    readings.push_back({specimen.youngs_modulus_kpa, *specimen.difference_mm});
  }
  if (readings.empty()) return std::nullopt;
  const ResidualEstimate& residual = record.residual;
  const double ring_mm = residual.sd_mm / std::sqrt(std::max(1.0, residual.n_effective));
  return stiffness_trend(readings, std::hypot(residual.specimen_spread_mm, ring_mm));
}

}  // namespace

Json to_json(const Calibration& calibration) {
  Json json;
  json["schema"] = kCalibrationSchema;
  json["method"] = to_string(calibration.method);
  json["virtual"] = calibration.is_virtual;
  json["chosen"] = calibration.chosen ? setting_json(*calibration.chosen, calibration.reference_step_s) : Json(nullptr);
  json["score_percent"] = or_null(calibration.score_percent);
  json["baseline_mm"] = calibration.table.baseline_mm;
  json["reference_step_s"] = calibration.reference_step_s;
  json["simulations"] = calibration.simulations;
  json["verdict"] = to_json(calibration.verdict);
  json["specimens"] = Json::array();
  for (const CalibratedSpecimen& specimen : calibration.specimens) json["specimens"].push_back(specimen_json(specimen));
  json["left_out"] = Json::array();
  for (const LeftOutSpecimen& one : calibration.left_out) {
    json["left_out"].push_back({{"name", one.name}, {"reason", one.reason}});
  }
  json["posterior"] = nullptr;
  if (calibration.fit) {
    const DragFit& fit = *calibration.fit;
    json["posterior"] = posterior_json(fit, *calibration.identifiability);
    json["residual"] = {{"sd_mm", fit.residual.sd_mm},
                        {"correlation_deg", fit.residual.correlation_deg},
                        {"reading_mm", fit.residual.reading_mm},
                        {"specimen_spread_mm", fit.residual.specimen_spread_mm},
                        {"placement_mm", fit.residual.placement_mm},
                        {"n_effective", fit.residual.n_effective}};
    json["fitted"] = fitted_json(fit);
    json["identifiability"] = calibration.identifiability->sentences;
  }
  json["rows"] = rows_json(calibration);
  return json;
}

CalibrationRecord read_calibration(const std::filesystem::path& path) {
  const Json json = read_json(path);
  if (!json.is_object()) throw DataError(path, "", "no object", "a calibration", kCalibrationHint);
  const JsonPlace file{path, json, "", kCalibrationHint};
  if (file.text("schema") != kCalibrationSchema)
    file.refuse("schema", file.text("schema").substr(0, 40), kCalibrationSchema);
  CalibrationRecord record;
  const std::string name = file.text("method");
  const auto method = value_of<CalibrationMethod>(name);
  if (!method) file.refuse("method", name.substr(0, 40), choices(names_of(CalibrationMethod{})));
  record.method = *method;
  record.is_virtual = file.flag("virtual");
  record.reference_step_s = within(file, "reference_step_s", kStepS);
  record.baseline_mm = within(file, "baseline_mm", kLengthMm);
  if (!file.at("chosen", "an object or null").is_null()) {
    const JsonPlace chosen = file.inside("chosen");
    record.chosen = RunSetting{within(chosen, "speed_mm_s", kSpeedMmS), within(chosen, "dullness", kDullness),
                               within(chosen, "stiffness_of_case", kRatio)};
  }
  for (const JsonPlace& specimen : file.objects("specimens")) record.specimens.push_back(specimen_from(specimen));
  if (record.method == CalibrationMethod::Paper) return record;
  record.samples = samples_from(file.inside("posterior"));
  read_differences(file, record);
  const JsonPlace residual = file.inside("residual");
  record.residual.sd_mm = within(residual, "sd_mm", kLengthMm);
  record.residual.correlation_deg = within(residual, "correlation_deg", kAngleDeg);
  record.residual.reading_mm = within(residual, "reading_mm", kLengthMm);
  record.residual.specimen_spread_mm = within(residual, "specimen_spread_mm", kLengthMm);
  record.residual.placement_mm = within(residual, "placement_mm", kLengthMm);
  record.residual.n_effective = within(residual, "n_effective", kPlaces);
  return record;
}

CalibratedBelief belief_of(const CalibrationRecord& record, const std::filesystem::path& path) {
  if (record.method != CalibrationMethod::Fit)
    throw DataError(path, "method", "paper", "fit: a grid of scores says nothing of how sure it is", kCalibrationHint);
  if (!record.chosen) throw DataError(path, "chosen", "null", "a setting with which a simulated ring closed");
  CalibratedBelief belief;
  belief.samples = record.samples;
  belief.residual = record.residual;
  belief.speed_mm_s = record.chosen->speed_mm_s;
  belief.knows_forces = !record.specimens.empty() &&
                        std::all_of(record.specimens.begin(), record.specimens.end(),
                                    [](const CalibratedSpecimenRecord& s) { return s.stretch_force_n.has_value(); });
  belief.trend = trend_of(record);
  return belief;
}

CalibratedRange range_of(const CalibrationRecord& record) {
  CalibratedRange range;
  for (const CalibratedSpecimenRecord& specimen : record.specimens) {
    if (specimen.stretch_force_n) range.youngs_modulus_kpa.push_back(specimen.youngs_modulus_kpa);
    if (specimen.stretch_force_n && specimen.stretch_mm > 0.0)
      range.compliance_mm_n.push_back(specimen.stretch_mm / *specimen.stretch_force_n);
    if (specimen.signed_error_mm) range.signed_error_mm.push_back(*specimen.signed_error_mm);
    if (!specimen.registration) continue;
    range.registration_rmse_mm.push_back(specimen.registration->rmse_mm);
    range.registration_scale.push_back(specimen.registration->scale);
  }
  return range;
}

}  // namespace incise
