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

/// What a calibration says of the next specimen.
struct CalibratedBelief {
  std::filesystem::path file;  ///< of the calibration, for messages
  std::vector<PosteriorSample> samples;
  std::vector<RingObservation> rings;  ///< its photographs, at least one, as many sectors each, 9 to 360
  std::size_t specimens = 0;           ///< that were fitted
  double speed_mm_s = 13.0;            ///< of the simulated tool; a drag length is reached by its dullness
  bool knows_forces = false;           ///< the pull of every calibration specimen was measured: stiffness is over that
};

/// Reports a search for a forecast's spreads that did not come to rest.
void warn_unless_converged(const RingForecaster& forecaster, Monitor& monitor);
/// Whether a simulation says something of photographs; a share of its differences outside kLikelyShare is reported.
/// @param file  of the calibration. @throws DataError for a share outside kUsableShare.
void require_usable_share(const std::filesystem::path& file, double simulated_share, Monitor& monitor);

/// What is known of this specimen's stiffness, and what is asked of the path.
struct ScenarioRequest {
  std::optional<double> stretch_force_n;  ///< measured pull at the case's stretch; absent: the case's modulus is used …
  double unknown_stiffness_sd =
      0.5;  ///< … to this, of its logarithm, where the calibration specimens' pull is known, > 0
  double max_probability = 0.05;  ///< of a close margin anywhere, (0, 1)
  std::uint64_t seed = 1;         ///< of the residuals that probabilities are counted over
};

/// One simulated cut of a scenario, as far as it is looked at: its inner edge.
struct ScenarioRun {
  RunSetting setting;
  std::optional<PathErrors> errors;  ///< absent: no closed ring
  std::vector<double> profile_mm;    ///< of its inner edge, from the start direction on; empty: likewise
  std::string problem;               ///< why it could not be carried out; empty: it was
};

inline void describe(Visitor& v, ScenarioRun& r) {
  v("setting", r.setting, "The tissue.");
  v("errors", r.errors, "Absent: no closed ring.");
  v({"profile_mm", "Signed error of its inner edge by sector, from the start direction on.", "mm"}, r.profile_mm);
  v("problem", r.problem, "Why it could not be carried out; empty: it was.");
}

/// The tissues that were simulated for a correction, and what photographs say beyond them.
struct ScenarioSet {
  std::vector<TissueScenario> tissues;
  std::vector<RunSetting> settings;  ///< one for each tissue
  double simulated_force_n = 0.0;    ///< pull of the specimen at the case's modulus
  double reference_kpa = 0.0;        ///< Young's modulus that stiffness factors are over
  double own_stiffness_sd = 0.0;     ///< of its logarithm; 0: the pull was measured, or that of no specimen was
  std::size_t photographs = 0;
  RingPrediction prediction;  ///< of the photograph of a cut as planned, beyond the middle tissue's
};

struct RobustCorrection {
  ScenarioSet scenarios;
  RobustSettings settings;
  std::vector<double> corrected_offset_mm;  ///< per waypoint: of the corrected path
  RobustCompensation compensation;
};

/// Chooses the path of least expected error by a calibration (see compensate_robust): the tissue that it expects is cut
/// along the intended, the corrected and the chosen path, and photographs of its specimens say how real cuts differ
/// (RingForecaster). Without a measured pull two more tissues are cut, side by side. What is measured is the inner
/// edge, tool out, as in the calibration, whatever line the case corrects by.
/// @param done  the case's study, with a correction by the default method.
/// A tissue that cannot be stretched counts as one that left nothing to measure.
/// @throws CaseError where force and calibration do not go together; Cancelled when the monitor asks to stop: finished
/// runs are in the cache.
[[nodiscard]] RobustCorrection correct_robustly(const Case& settings, Inputs& inputs, Cache& cache, const Study& done,
                                                const CalibratedBelief& belief, const ScenarioRequest& request,
                                                Workers& workers, Monitor& monitor);

struct CorrectionOutlook {
  ScenarioSet scenarios;
  RobustSettings settings;
  PathOutlook paths;
};
void describe(Visitor& v, RobustCorrection& r);

/// The tissues that were simulated, the specimen's reference stiffness and what photographs say beyond them.
void describe_scenarios(Visitor& v, ScenarioSet& scenarios);

/// The same cuts along the intended and the corrected path alone: what the correction is expected to win.
[[nodiscard]] CorrectionOutlook foresee_correction(const Case& settings, Inputs& inputs, Cache& cache,
                                                   const Study& done, const CalibratedBelief& belief,
                                                   const ScenarioRequest& request, Workers& workers, Monitor& monitor);

}  // namespace incise
