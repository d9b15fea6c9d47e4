#pragma once

#include <incise/calibration/calibration_run.hpp>
#include <incise/calibration/ring_forecast.hpp>
#include <incise/calibration/tissue_scenarios.hpp>
#include <incise/core/cache.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/planning/robust_compensation.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/inputs.hpp>
#include <incise/workflow/study.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// What a calibration knows about the next specimen.
struct CalibratedBelief {
  std::filesystem::path file;  ///< of the calibration, for messages
  std::vector<PosteriorSample> samples;
  std::vector<RingObservation> rings;  ///< its photographs, at least one, all with the same number of sectors, 9 to 360
  std::size_t specimens = 0;           ///< number of specimens that were fitted
  double speed_mm_s = 13.0;            ///< of the simulated tool; its dullness sets the drag length
  bool knows_forces = false;  ///< the pull of every calibration specimen was measured: it sets the reference stiffness
};

/// Warns if the search for a forecast's spreads did not converge.
void warn_unless_converged(const RingForecaster& forecaster, Monitor& monitor);
/// Checks that the simulation predicts photographs. Reports a share of simulated differences outside kLikelyShare.
/// @param file  of the calibration. @throws DataError for a share outside kUsableShare.
void require_usable_share(const std::filesystem::path& file, double simulated_share, Monitor& monitor);

/// What is known of this specimen's stiffness, and the risk that its path may take.
struct ScenarioRequest {
  std::optional<double> stretch_force_n;  ///< measured pull at the case's stretch; absent: the case's modulus holds …
  double unknown_stiffness_sd =
      0.5;                        ///< … with this sd of its logarithm, if the calibration specimens' pull is known, > 0
  double max_probability = 0.05;  ///< of a close margin anywhere along the cut, (0, 1)
  std::uint64_t seed = 1;         ///< of the residuals that probabilities are counted over
};

/// One simulated cut of a scenario, by its inner edge.
struct ScenarioRun {
  RunSetting setting;
  std::optional<PathErrors> errors;  ///< absent: no closed ring
  std::vector<double> profile_mm;    ///< signed error of its inner edge by sector, from the start on; empty: likewise
  std::string problem;               ///< why it could not be carried out; empty: it was
};

inline void describe(Visitor& v, ScenarioRun& r) {
  v("setting", r.setting, "Settings with which the cut was simulated.");
  v("errors", r.errors, "Errors of the cut; absent: no closed ring.");
  v({"profile_mm", "Signed error of its inner edge by sector, from the start direction on.", "mm"}, r.profile_mm);
  v("problem", r.problem, "Why the cut could not be simulated; empty: it was.");
}

/// The tissues that were simulated for a correction, and the differences of real cuts that photographs show.
struct ScenarioSet {
  std::vector<TissueScenario> tissues;
  std::vector<RunSetting> settings;  ///< one for each tissue
  double simulated_force_n = 0.0;    ///< pull of the specimen at the case's modulus
  double reference_kpa = 0.0;        ///< Young's modulus of the reference of stiffness factors
  double own_stiffness_sd = 0.0;     ///< of its logarithm; 0: the pull was measured, or never for the calibration
  std::size_t photographs = 0;
  RingPrediction prediction;  ///< of the photograph of a cut as planned, beyond the first tissue's simulation
};

/// Result of correct_robustly.
struct RobustCorrection {
  ScenarioSet scenarios;
  RobustSettings settings;
  std::vector<double> corrected_offset_mm;  ///< per waypoint: of the corrected path
  RobustCompensation compensation;
};

/// Chooses the path of least expected error by a calibration (see compensate_robust). The tissue that the calibration
/// expects is cut along the intended, the corrected and the chosen path, and photographs of its specimens show how real
/// cuts differ (RingForecaster). Without a measured pull, two more tissues may be cut, side by side (see
/// tissue_scenarios). As in the calibration, cuts are measured by their inner edge, tool out, whatever line the case
/// corrects by. A tissue that cannot be stretched counts as one with nothing to measure.
/// @param done  the case's study, with a correction by the default method.
/// @throws CaseError if only one of request and calibration has the pull; DataError for a share outside kUsableShare;
/// InvalidArgument without such a correction; Cancelled when the monitor asks to stop: finished runs are in the cache.
[[nodiscard]] RobustCorrection correct_robustly(const Case& settings, Inputs& inputs, Cache& cache, const Study& done,
                                                const CalibratedBelief& belief, const ScenarioRequest& request,
                                                Workers& workers, Monitor& monitor);

/// Result of foresee_correction.
struct CorrectionOutlook {
  ScenarioSet scenarios;
  RobustSettings settings;
  PathOutlook paths;
};
void describe(Visitor& v, RobustCorrection& r);

/// Describes the simulated tissues, the specimen's reference stiffness and the differences that photographs show.
void describe_scenarios(Visitor& v, ScenarioSet& scenarios);

/// Makes the same cuts along the intended and the corrected path only, to estimate the gain of the correction. @throws
/// as correct_robustly.
[[nodiscard]] CorrectionOutlook foresee_correction(const Case& settings, Inputs& inputs, Cache& cache,
                                                   const Study& done, const CalibratedBelief& belief,
                                                   const ScenarioRequest& request, Workers& workers, Monitor& monitor);

}  // namespace incise
