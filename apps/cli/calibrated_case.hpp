#pragma once

#include "study_run.hpp"

#include <incise/storage/calibration_file.hpp>
#include <incise/storage/robust_files.hpp>

#include <fmt/format.h>

#include <optional>

namespace incise::cli {

/// What the verbs that plan by a calibration understand.
struct CalibratedOptions {
  std::filesystem::path calibration;
  std::optional<double> stretch_force_n;
};
/// --calibration and --stretch-force-n. @returns the first.
CLI::Option* add_calibrated_options(CLI::App& verb, CalibratedOptions& options);

/// A calibration's file, read and looked through before anything is computed.
struct CalibrationInput {
  std::filesystem::path file;
  Calibration found;
  CalibratedBelief belief;
};
/// @throws DataError for a file that is missing, damaged or without a posterior; CaseError for a force where the
/// calibration has none.
[[nodiscard]] CalibrationInput read_calibration_input(const CalibratedOptions& options);

/// Runs what needs the tissues of a calibration; what is kept of it when it is interrupted is said.
template <class Work>
auto with_tissues(StudyRun& run, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const CaseError& error) {
    throw error.in_file(run.folder.case_file().file.string());
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("what was finished is kept in {}", run.folder.root().string()));
  }
}

/// The case's part of what is asked.
[[nodiscard]] ScenarioRequest scenario_request(const CalibratedOptions& chosen, const CommonOptions& options);

}  // namespace incise::cli
