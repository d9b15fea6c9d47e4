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

/// A case, where its results go, and how far and how it is run.
struct CaseRequest {
  CaseFile file;
  std::filesystem::path output;
  RunOptions options;
};

/// The whole loop: plan, cut, correct, cut again; the robot program that the verdict allows, report and figures.
/// @param accepted  ids of the cautions that a person takes on them.
/// Not acceptable: an outcome other than success, a verdict that refuses the run, no program where the case says where
/// the specimen lies. @throws as CaseRun::run.
/// @param on_run  called with the run once its files are written and before the report is drawn; may be empty.
[[nodiscard]] StepResult run_loop(const CaseRequest& request, const std::vector<std::string>& accepted,
                                  const StepContext& context, const std::function<void(const Run&)>& on_run = {});

/// The held specimen for another solver.
enum class InterchangeFormat { Sofa, Febio };
inline constexpr std::array<std::string_view, 2> kInterchangeFormatNames{"sofa", "febio"};
[[nodiscard]] constexpr Names names_of(InterchangeFormat) {
  return kInterchangeFormatNames;
}
/// Writes a folder with case.scn (SOFA) or case.feb (FEBio) and its manifest. Where the case has no mesh it is made,
/// and kept beside the case as its run does. @throws DataError; CaseError for what the format cannot say.
[[nodiscard]] StepResult write_for_solver(const CaseFile& file, InterchangeFormat format,
                                          const std::filesystem::path& output, const StepContext& context);

/// Runs a case up to a stage before the verifying cut and shows the last product: stretch, plan, cut as planned, or
/// corrected path. Not acceptable: a stretch or a cut that fails, a verdict that refuses the cut, no correction.
/// @throws as CaseRun::study.
[[nodiscard]] StepResult run_stages(const CaseRequest& request, const StepContext& context);

/// What is known of a specimen beside its case: a calibration, and what was measured of it.
struct CalibratedRequest {
  std::filesystem::path calibration;      ///< calibration.json of the method fit
  std::optional<double> stretch_force_n;  ///< measured pull at the stretch, > 0
};

/// A calibration's file, read and looked through before anything is computed.
struct CalibrationInput {
  CalibratedRequest request;
  Calibration found;
  CalibratedBelief belief;
};
/// @throws DataError for a file that is missing, damaged or without a posterior; CaseError for a force where the
/// calibration has none.
[[nodiscard]] CalibrationInput read_calibration_input(const CalibratedRequest& request);

/// The path of least expected error by a calibration is asked for, too.
struct RobustRequest {
  CalibrationInput calibration;
  double max_probability = ScenarioRequest{}.max_probability;  ///< of a close margin anywhere
};
/// Corrects the path of a case and verifies it by another cut.
/// Not acceptable: a correction that is not accepted, or a verdict that refuses its cut. @throws as CaseRun::study;
/// CaseError for a robust path of another method than the default, or where case and calibration differ in the rule of
/// their cuts.
[[nodiscard]] StepResult compensate_case(const CaseRequest& request, const std::optional<RobustRequest>& robust,
                                         const StepContext& context);

/// Should a case be cut along its corrected path? A ring that is corrected pass by pass.
/// @param registration  file of the specimen's registration.
/// Not acceptable: the advice not to use the simulation. @throws DataError, CaseError, also where case and calibration
/// differ in the rule of their cuts; as CaseRun::study.
[[nodiscard]] StepResult assess_case(const CaseRequest& request, const CalibrationInput& calibration,
                                     const std::filesystem::path& registration, const StepContext& context);

/// What the photographs of a calibration say of the error of a case's ring before it is cut, with and without its
/// simulation; kept in forecast/ of the run's folder. The modulus of the case counts as that of its pull.
/// Not acceptable: a specimen that cannot be stretched. @throws DataError for a calibration without fit or rings;
/// CaseError for a plan that is no ring; as CaseRun::study.
[[nodiscard]] StepResult forecast_case(const CaseRequest& request, const std::filesystem::path& calibration,
                                       const StepContext& context);

/// From photographed cuts to the simulated tool that cuts like them.
struct CalibrateRequest {
  std::vector<std::filesystem::path> cases;          ///< of each specimen: how it was held, and its path
  std::vector<std::filesystem::path> observed;       ///< of each: its evaluation
  std::vector<double> forces_n;                      ///< of each its pull at the stretch; or none
  std::vector<std::filesystem::path> registrations;  ///< of each; or none
  CalibrationRequest request;                        ///< valid
  std::filesystem::path output;                      ///< folder
};
struct CalibrateResult {
  StepResult step;
  Calibration calibration;
};
/// Not acceptable: a calibration that chose nothing. @throws DataError, CaseError as calibrate; StagesKept.
[[nodiscard]] CalibrateResult calibrate_on_cuts(const CalibrateRequest& request, const StepContext& context);

/// Keeps parts out of a folder that something else filled. @param signs  files or folders of which one is there as soon
/// as anything of ours is. @param what  the parts, for the message: "a series".
/// @throws DataError for a folder that is not empty and has none of them.
void require_own_or_empty(const std::filesystem::path& folder, const std::vector<std::string>& signs,
                          const std::string& what);
/// Runs what fills an output folder part by part, and keeps other runs out of it meanwhile. Stopped on request, it says
/// that finished parts are kept. A folder that it made and that holds no file yet when it ends by an error is removed.
/// @throws StagesKept in place of Cancelled where something is kept; whatever `run` throws.
void with_parts_kept(const std::filesystem::path& output, const std::function<void()>& run);

}  // namespace incise::steps
