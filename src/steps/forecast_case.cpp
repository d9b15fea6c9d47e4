#include "steps/calibrated_case.hpp"

#include <incise/calibration/ring_forecast.hpp>
#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/workflow/ring_covariates.hpp>

namespace incise::steps {
namespace {

using ForecastJson = nlohmann::ordered_json;

/// One of both ways to forecast, and what `compensation` of the case has to say to correct by it.
ForecastJson forecast_json(const RingForecaster& forecaster, const RingCovariates& ring) {
  const RingForecast forecast = forecaster.forecast(ring);
  ForecastJson json = to_json(forecast);
  json["spreads"] = to_json(forecaster.spreads());
  json["hand_eye"] = to_json(forecaster.hand_eye());
  if (forecast.simulated_share != 0.0) {
    json["compensation"] = {{"simulated_share", forecast.simulated_share}, {"residual_mm", forecast.residual_mm}};
  } else {
    json["compensation"] = {{"method", "profile"}, {"photographed_mm", forecast.residual_mm}};
  }
  return json;
}

}  // namespace

StepResult forecast_case(const CaseRequest& request, const std::filesystem::path& calibration,
                         const StepContext& context) {
  const Calibration found = read_calibration(calibration);
  const std::vector<RingObservation> observations = ring_observations(found);
  if (observations.empty())
    throw DataError(calibration, "specimens", "no specimen with its ring and fitted errors",
                    "a calibration of the method fit by this version", "Calibrate anew: finished simulations are kept");
  if (request.file.settings.plan.kind != PlanKind::Ring)
    throw CaseError("case", "plan.kind", std::string(to_string(request.file.settings.plan.kind)), "ring")
        .in_file(request.file.file.string());
  CaseRun run(request.file, request.output, request.options, context.run);
  const Study study = run.study(context.workers, context.monitor);
  StepResult result;
  if (!study.plan) {
    result.json = to_json(*study.stretched);
    result.is_acceptable = false;
    return result;
  }
  const Case& settings = run.folder.case_file().settings;
  const RingCovariates ring = ring_covariates(settings, *study.model, study.stretched->state.positions,
                                              study.plan->tumor_edge, settings.material.youngs_modulus_kpa);
  result.json["specimen_is"] = settings.is_virtual ? "virtual" : "real";
  result.json["calibration_is"] = found.is_virtual ? "virtual" : "real";
  result.json["photographs"] = observations.size();
  result.json["ring"] = to_json(ring);
  result.json["in_view_mm"] = photographed_in_view(observations, ring.start_deg);
  result.json["without_simulation"] = forecast_json({observations, false}, ring);
  result.json["with_simulation"] = forecast_json({observations, true}, ring);
  const std::filesystem::path folder = run.folder.root() / "forecast";
  require_replaceable(folder);
  AtomicFolder target(folder);
  ForecastJson kept = result.json;
  kept["calibration_sha256"] = sha256_of_file(calibration);
  write_json(target.path() / "forecast.json", kept);
  run.folder.write_manifest_to(target.path(), context.wall_s());
  target.commit();
  result.json["folder"] = folder.string();
  return result;
}

}  // namespace incise::steps
