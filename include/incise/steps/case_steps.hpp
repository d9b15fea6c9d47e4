#pragma once

#include <incise/steps/step.hpp>
#include <incise/storage/calibration_file.hpp>
#include <incise/storage/case_run.hpp>
#include <incise/storage/robust_files.hpp>
#include <incise/workflow/calibrate.hpp>

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::steps {

/// A case, the folder for its results, and how far and how it is run.
struct CaseRequest {
  CaseFile file;
  std::filesystem::path output;
  RunOptions options;
};

/// Runs the whole loop: plan, cut, correct, cut again. Then writes the robot program if the verdict allows it, the
/// report and the figures.
/// Not acceptable: an outcome other than success, a verdict that refuses the run, or no program although the case says
/// where the specimen lies (T_robot_sim).
/// @param accepted  ids of the cautions that a person accepts.
/// @param on_run  called with the run once its files are written and before the report is drawn; may be empty.
/// @throws as CaseRun::run.
[[nodiscard]] StepResult run_loop(const CaseRequest& request, const std::vector<std::string>& accepted,
                                  const StepContext& context, const std::function<void(const Run&)>& on_run = {});

/// File formats of write_for_solver, for other solvers.
enum class InterchangeFormat { Sofa, Febio };
inline constexpr std::array<std::string_view, 2> kInterchangeFormatNames{"sofa", "febio"};
[[nodiscard]] constexpr Names names_of(InterchangeFormat) {
  return kInterchangeFormatNames;
}
/// Writes the held specimen into a folder: case.scn (SOFA) or case.feb (FEBio), and its manifest. If the case has no
/// mesh, one is made and kept beside the case, as its run does. @throws DataError; CaseError for what the format cannot
/// express.
[[nodiscard]] StepResult write_for_solver(const CaseFile& file, InterchangeFormat format,
                                          const std::filesystem::path& output, const StepContext& context);

/// Runs a case up to a stage before the verifying cut and returns the last product: stretch, plan, cut as planned, or
/// corrected path. Not acceptable: a stretch or a cut that fails, a verdict that refuses the cut, no correction.
/// @throws as CaseRun::study.
[[nodiscard]] StepResult run_stages(const CaseRequest& request, const StepContext& context);

/// Knowledge of a specimen beside its case: a calibration, and what was measured on the specimen.
struct CalibratedRequest {
  std::filesystem::path calibration;      ///< calibration.json of the method fit
  std::optional<double> stretch_force_n;  ///< measured pull at the stretch, N, > 0; absent: not measured
};

/// A calibration that was read from its file and checked.
struct CalibrationInput {
  CalibratedRequest request;
  Calibration found;
  CalibratedBelief belief;
};
/// Reads and checks a calibration. @throws DataError for a file that is missing, damaged or without a posterior;
/// CaseError for a force if the calibration was made without forces.
[[nodiscard]] CalibrationInput read_calibration_input(const CalibratedRequest& request);

/// Requests the robust path of a calibration in addition to the correction.
struct RobustRequest {
  CalibrationInput calibration;
  double max_probability = ScenarioRequest{}.max_probability;  ///< greatest probability of a close margin anywhere
};
/// Corrects the path of a case and verifies it by another cut. Not acceptable: a correction that is not accepted, a
/// robust path that was requested and does not keep `max_probability`, or a verdict that refuses the cut. @throws as
/// CaseRun::study; CaseError for a robust path with another method than the default, on a path that the case gives, or
/// where case and calibration differ in the rule of their cuts.
[[nodiscard]] StepResult compensate_case(const CaseRequest& request, const std::optional<RobustRequest>& robust,
                                         const StepContext& context);

/// Assesses whether a case should be cut along its corrected path. The case must plan a ring and correct it by the
/// default method.
/// @param registration  file of the specimen's registration.
/// Not acceptable: the advice not to use the simulation. @throws DataError; CaseError, also where case and calibration
/// differ in the rule of their cuts; as CaseRun::study.
[[nodiscard]] StepResult assess_case(const CaseRequest& request, const CalibrationInput& calibration,
                                     const std::filesystem::path& registration, const StepContext& context);

/// Forecasts the error of a case's ring before it is cut, from the photographs of a calibration, with and without the
/// ring's simulation, and keeps it in forecast/ of the run's folder. The case's modulus is used as the modulus that its
/// pull indicates.
/// Not acceptable: a specimen that cannot be stretched. @throws DataError for a calibration without fit or rings;
/// CaseError for a plan that is no ring, or where case and calibration differ in the rule of their cuts; as
/// CaseRun::study.
[[nodiscard]] StepResult forecast_case(const CaseRequest& request, const std::filesystem::path& calibration,
                                       const StepContext& context);

/// Input of calibrate_on_cuts: photographed cuts and their cases.
struct CalibrateRequest {
  std::vector<std::filesystem::path> cases;          ///< one per specimen: how it was held, and its path
  std::vector<std::filesystem::path> observed;       ///< evaluation of the cut, one per specimen
  std::vector<double> forces_n;                      ///< pull at the stretch, N, one per specimen; or empty
  std::vector<std::filesystem::path> registrations;  ///< one per specimen; or empty
  CalibrationRequest request;                        ///< valid
  std::filesystem::path output;                      ///< folder
};
struct CalibrateResult {
  StepResult step;
  Calibration calibration;
};
/// Finds the simulated tool that cuts as the photographs show. Not acceptable: a calibration that chose nothing.
/// @throws DataError, CaseError as calibrate; StagesKept.
[[nodiscard]] CalibrateResult calibrate_on_cuts(const CalibrateRequest& request, const StepContext& context);

/// Refuses an output folder that another program filled.
/// @param signs  files or folders, at least one of which exists in every folder of ours that is not empty.
/// @param what  the folder's parts, for the message: "a series".
/// @throws DataError for a folder that is not empty and has none of `signs`.
void require_own_or_empty(const std::filesystem::path& folder, const std::vector<std::string>& signs,
                          const std::string& what);
/// Calls `run`, which fills an output folder part by part, and locks the folder against other runs meanwhile. When
/// stopped on request, the message says that finished parts are kept. If `run` fails, a new output folder without files
/// is removed.
/// @throws StagesKept in place of Cancelled if something is kept; whatever `run` throws.
void with_parts_kept(const std::filesystem::path& output, const std::function<void()>& run);

}  // namespace incise::steps
