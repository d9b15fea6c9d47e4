#pragma once

#include <incise/core/error.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>

namespace incise::steps {

/// Runs work that needs the tissues of a calibration. If it is interrupted, the error says what is kept.
template <class Work>
auto with_tissues(CaseRun& run, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const CaseError& error) {
    throw error.in_file(run.folder.case_file().file.string());
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("what was finished is kept in {}", run.folder.root().string()));
  }
}

/// Returns the scenarios' settings with the measured pull and the seed.
[[nodiscard]] ScenarioRequest scenario_request(const CalibratedRequest& request, const StepContext& context);

/// Requires one rule of cutting: the tissues and the bias of a calibration hold only for the rule of its cuts.
/// @throws CaseError where the case cuts by another rule than the calibration did.
void require_rule_of(const CalibrationInput& calibration, const CaseFile& file);

/// Requires the planned path: the photographs of a ring apply only to a cut along it.
/// @throws CaseError for a case that gives a path of its own.
void require_planned_path(const CaseFile& file);

/// Returns a warning if the case cuts with another simulated tool than the calibration chose, which is seldom intended.
/// Empty: the tool is the same, or the calibration chose none.
[[nodiscard]] std::string other_tool(const CutSettings& cut, const Calibration& calibration);

}  // namespace incise::steps
