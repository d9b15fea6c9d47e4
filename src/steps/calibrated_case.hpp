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

}  // namespace incise::steps
