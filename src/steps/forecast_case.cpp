#include "steps/calibrated_case.hpp"

#include <incise/calibration/ring_forecast.hpp>
#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/ring_covariates.hpp>

namespace incise::steps {
namespace {

using ForecastJson = nlohmann::ordered_json;

/// Returns one forecast, with or without simulation, and the spreads of its model.
ForecastJson forecast_json(const CalibratedBelief& belief, const RingCovariates& ring, bool with_simulation,
                           Monitor& monitor) {
  const RingForecaster forecaster(belief.rings, with_simulation);
  warn_unless_converged(forecaster, monitor);
  const RingForecast forecast = forecaster.forecast(ring);
  if (with_simulation) require_usable_share(belief.file, forecast.simulated_share, monitor);
  ForecastJson json = to_json(forecast);
  json["converged"] = forecaster.is_converged();
  json["spreads"] = to_json(forecaster.spreads());
  json["hand_eye"] = to_json(forecaster.hand_eye());
  if (!with_simulation)
    json["compensation"] = {{"method", "profile"}, {"photographed_mm", forecast.residual_mm}};
  else
    json["compensation"] = {{"observable", "inner_edge"},
                            {"bias_mm", tissue_scenarios(belief.samples, 0.0).front().bias_mm},
                            {"simulated_share", forecast.simulated_share},
                            {"residual_mm", forecast.residual_mm}};
  return json;
}

}  // namespace

StepResult forecast_case(const CaseRequest& request, const std::filesystem::path& calibration,
                         const StepContext& context) {
  const CalibrationInput input = read_calibration_input({calibration, std::nullopt});
  if (request.file.settings.plan.kind != PlanKind::Ring)
    throw CaseError("case", "plan.kind", std::string(to_string(request.file.settings.plan.kind)), "ring")
        .in_file(request.file.file.string());
  require_rule_of(input, request.file);
  const std::string note = other_tool(request.file.settings.cut, input.found);
  if (!note.empty()) context.monitor.message(Severity::Warning, note);
  CaseRun run(request.file, request.output, request.options, context.run);
  const Study study = run.study(context.workers, context.monitor);
  StepResult result;
  if (!study.plan) {
    result.json = to_json(*study.stretched);
    result.is_acceptable = false;
    return result;
  }
  const Case& settings = run.folder.case_file().settings;
  if (input.found.is_virtual && !settings.is_virtual)
    context.monitor.message(Severity::Warning, fmt::format("forecast: {}", kVirtualCalibration));
  const RingCovariates ring = ring_covariates(settings, *study.model, study.stretched->state.positions,
                                              study.plan->tumor_edge, settings.material.youngs_modulus_kpa);
  ForecastJson& json = result.json;
  json["specimen_is"] = settings.is_virtual ? "virtual" : "real";
  json["calibration_is"] = input.found.is_virtual ? "virtual" : "real";
  json["photographs"] = input.belief.rings.size();
  json["calibrated"] = input.found.specimens.size();
  json["ring"] = to_json(ring);
  json["in_view_mm"] = photographed_in_view(input.belief.rings, ring.start_deg);
  json["without_simulation"] = forecast_json(input.belief, ring, false, context.monitor);
  json["with_simulation"] = forecast_json(input.belief, ring, true, context.monitor);
  const std::filesystem::path folder = run.folder.root() / "forecast";
  require_replaceable(folder);
  AtomicFolder target(folder);
  ForecastJson kept = json;
  kept["calibration_sha256"] = sha256_of_file(calibration);
  write_json(target.path() / "forecast.json", kept);
  run.folder.write_manifest_to(target.path(), context.wall_s());
  target.commit();
  json["folder"] = folder.string();
  return result;
}

}  // namespace incise::steps
