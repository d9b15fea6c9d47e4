#include "planning/scenario_cuts.hpp"

#include "planning/tissue_response.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {

std::vector<ScenarioErrors> moved_errors(const std::vector<LinearScenario>& scenarios, const Eigen::VectorXd& move) {
  std::vector<ScenarioErrors> errors;
  for (const LinearScenario& s : scenarios) errors.push_back({s.weight, s.error_mm + s.response * move});
  return errors;
}

ScenarioCuts::ScenarioCuts(const ToolPath& intended, const SurfaceQuery& surface,
                           const std::vector<CutScenario>& scenarios, const MeasureScenarios& measure,
                           const CutResidual& residual, const RobustSettings& settings)
    : intended_(intended),
      scenarios_(scenarios),
      measure_(measure),
      expected_residual_mm_(as_vector(residual.mean_mm)),
      settings_(settings),
      course_(intended),
      movable_(intended, surface, settings.region),
      risk_(residual, settings) {
  for (const CutScenario& scenario : scenarios) all_weights_ += scenario.weight;
}

ScenarioCuts::Cut ScenarioCuts::along_intended() {
  const std::size_t n = course_.waypoints();
  return along({intended_, std::vector<double>(n, 0.0), std::vector<std::uint8_t>(n, 0)});
}

ScenarioCuts::Cut ScenarioCuts::along(MovablePath::Moved moved) {
  Cut made{std::move(moved), {}, {}};
  const std::vector<std::optional<PathErrors>> measured = measure_(made.moved.path);
  INCISE_REQUIRE(measured.size() == scenarios_.size(),
                 fmt::format("expected a measure, or none, for each of {} scenarios, found {}", scenarios_.size(),
                             measured.size()));
  simulations_ += scenarios_.size();
  double weight = 0.0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    if (!measured[k]) continue;
    made.scenarios.push_back(linear(k, *measured[k]));
    weight += made.scenarios.back().weight;
  }
  if (!made.scenarios.empty()) {
    const auto still = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(course_.waypoints()));
    made.risk = risk_.of(moved_errors(made.scenarios, still));
  }
  made.risk.unmeasured_weight = made.scenarios.size() == scenarios_.size() ? 0.0 : 1.0 - weight;
  return made;
}

LinearScenario ScenarioCuts::linear(std::size_t place, const PathErrors& errors) const {
  std::vector<double> along_mm;
  for (const Vec3& p : errors.places) along_mm.push_back(course_.along_mm(p));
  std::vector<double> expected = errors.signed_error_mm;
  for (double& error : expected) error += scenarios_[place].bias_mm;
  const std::vector<double> at_waypoints = course_.average(along_mm, expected, settings_.smoothing_mm).value;
  const TissueResponse response(course_, settings_.shift_lags * errors.lag_mm, settings_.spread_lags * errors.lag_mm);
  return {place, scenarios_[place].weight / all_weights_, as_vector(at_waypoints) + expected_residual_mm_,
          response.matrix()};
}

void require_scenarios(const ToolPath& intended, const std::vector<double>& corrected_offset_mm,
                       const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
                       const CutResidual& residual, const RobustSettings& settings) {
  require_none(problems_of(settings));
  INCISE_REQUIRE(intended.is_closed && intended.tumor_edge.points.size() >= 3,
                 "expected a closed path with a tumour edge of at least 3 points");
  INCISE_REQUIRE(corrected_offset_mm.size() == intended.waypoints.size(),
                 fmt::format("expected an offset for each of {} waypoints, found {}", intended.waypoints.size(),
                             corrected_offset_mm.size()));
  const auto n = static_cast<Eigen::Index>(intended.waypoints.size());
  INCISE_REQUIRE(residual.mean_mm.size() == intended.waypoints.size() && residual.covariance_mm2.rows() == n &&
                     residual.covariance_mm2.cols() == n,
                 fmt::format("expected a residual at each of {} waypoints, found {}", n, residual.mean_mm.size()));
  INCISE_REQUIRE(residual.covariance_mm2.allFinite() && (residual.covariance_mm2.diagonal().array() > 0.0).all(),
                 "expected a residual with variances above 0");
  for (const double mean : residual.mean_mm) INCISE_REQUIRE(std::isfinite(mean), "expected finite residuals");
  INCISE_REQUIRE(
      residual.degrees == 0 || residual.degrees > 2,
      fmt::format("expected a residual with 0 or more than 2 degrees of freedom, found {}", residual.degrees));
  INCISE_REQUIRE(!scenarios.empty(), "expected at least one scenario");
  for (const CutScenario& scenario : scenarios) {
    INCISE_REQUIRE(std::isfinite(scenario.weight) && scenario.weight > 0.0 && std::isfinite(scenario.bias_mm),
                   fmt::format("expected scenarios with weights above 0 and finite biases, found {} and {}",
                               scenario.weight, scenario.bias_mm));
  }
  check_path_as({"compensation"}, intended, surface, settings.region.approach, 0.0);
}

}  // namespace incise
