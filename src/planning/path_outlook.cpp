#include "planning/scenario_cuts.hpp"

namespace incise {
namespace {

/// Errors of one cut in the scenarios that were measured along both paths.
std::vector<ScenarioErrors> errors_in_common(const ScenarioCuts::Cut& of, const ScenarioCuts::Cut& with) {
  std::vector<ScenarioErrors> errors;
  for (const LinearScenario& mine : of.scenarios) {
    for (const LinearScenario& other : with.scenarios) {
      if (mine.place == other.place) errors.push_back({mine.weight, mine.error_mm});
    }
  }
  return errors;
}

}  // namespace

PathOutlook foresee_paths(const ToolPath& intended, const std::vector<double>& corrected_offset_mm,
                          const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
                          const MeasureScenarios& measure, const CutResidual& residual,
                          const RobustSettings& settings) {
  require_scenarios(intended, corrected_offset_mm, surface, scenarios, residual, settings);
  ScenarioCuts cuts(intended, surface, scenarios, measure, residual, settings);
  const ScenarioCuts::Cut planned = cuts.along_intended();
  const ScenarioCuts::Cut corrected = cuts.along(corrected_offset_mm);
  PathOutlook outlook;
  outlook.intended = planned.risk;
  outlook.corrected = corrected.risk;
  const std::vector<ScenarioErrors> before = errors_in_common(planned, corrected);
  if (!before.empty()) outlook.gain = cuts.risk().gain(before, errors_in_common(corrected, planned));
  return outlook;
}

}  // namespace incise
