#pragma once

#include <incise/core/error.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>

namespace incise::steps {

/// Runs what needs the tissues of a calibration; what is kept of it when it is interrupted is said.
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

/// The case's part of what is asked.
[[nodiscard]] ScenarioRequest scenario_request(const CalibratedRequest& request, const StepContext& context);

/// The tissues and the bias of a calibration are those of one law of cutting.
/// @throws CaseError where the case cuts by another rule than the calibration did.
void require_rule_of(const CalibrationInput& calibration, const CaseFile& file);

/// What photographs say of a ring holds for a cut along the planned path.
/// @throws CaseError for a case that gives a path of its own.
void require_planned_path(const CaseFile& file);

/// What is to be said where the case cuts with another simulated tool than the calibration chose: that is seldom meant.
/// Empty: it is the same.
[[nodiscard]] std::string other_tool(const CutSettings& cut, const Calibration& calibration);

}  // namespace incise::steps
