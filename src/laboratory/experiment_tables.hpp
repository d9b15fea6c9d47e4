#pragma once

#include "laboratory/specimen_trial.hpp"

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::laboratory {

enum class TrialRole { Calibrate, Test, Outside };
inline constexpr std::array<std::string_view, 3> kTrialRoleNames{"calibrate", "test", "outside"};
[[nodiscard]] constexpr Names names_of(TrialRole) {
  return kTrialRoleNames;
}

/// A path along which test specimens are cut, in addition to the planned and the corrected one.
enum class RivalPath {
  Constant,         ///< moved outwards by one number, the mean signed error of the calibration's photographs
  Profile,          ///< moved by the photographs' mean error by direction
  ProfileSmoothed,  ///< the same, without short waves
  ProfileInView,    ///< moved by the photographs' mean error by direction in the view, wherever each cut started
  Photographs,      ///< moved by the photographs' forecast for this ring, see RingForecaster; no simulation
  PaperPass,        ///< the paper's single pass by the simulated mid-line, with the calibrated tool
  Uncalibrated,     ///< corrected with the default tool and no bias
  Hybrid,           ///< corrected; the photographs add, by direction, what the simulation misses
  Learned,          ///< corrected; the photographs' forecast for this ring adds what the simulation misses
  Robust,           ///< the path of least expected error over the calibration's posterior
};
inline constexpr std::array<std::string_view, 10> kRivalPathNames{
    "constant",    "profile",    "profile_smoothed",    "profile_in_view",
    "photographs", "paper_pass", "incise_uncalibrated", "hybrid",
    "learned",     "robust"};
[[nodiscard]] constexpr Names names_of(RivalPath) {
  return kRivalPathNames;
}
/// Whether no simulated cut takes part in the path.
[[nodiscard]] constexpr bool is_without_simulation(RivalPath path) {
  return path <= RivalPath::Photographs;
}

/// Whether the path is computed from a forecast.
[[nodiscard]] constexpr bool is_of_forecast(RivalPath path) {
  return path == RivalPath::ProfileInView || path == RivalPath::Photographs || path == RivalPath::Learned;
}

struct RivalCut {
  RivalPath path = RivalPath::Constant;
  TrialCut cut;
};

/// A cut along the forecast from only the first photographs.
struct LearningCut {
  std::size_t photographs = 0;
  RivalPath path = RivalPath::Photographs;  ///< or Learned
  TrialCut cut;
};

/// One specimen of an experiment, and its results.
struct Trial {
  std::string name;
  std::uint64_t seed = 0;
  TrialRole role = TrialRole::Calibrate;
  std::string kind;                                   ///< of a specimen outside the calibrated range; else empty
  std::vector<std::pair<std::string, double>> given;  ///< hidden parameters that are not drawn from the seed
  TrialCut planned, corrected;
  std::vector<RivalCut> rivals;                    ///< the requested ones
  std::vector<LearningCut> learning;               ///< the requested ones
  TrialCut withheld;                               ///< corrected as if the pull was not measured; only if requested
  nlohmann::ordered_json compensation;             ///< output of `incise compensate`; null: not run
  nlohmann::ordered_json assessment;               ///< output of `incise assess`; null: not run
  nlohmann::ordered_json assessment_without_pull;  ///< the same as if the pull had not been measured
  nlohmann::ordered_json known_physics;            ///< output of `incise bench floor`; null: not run
  double stretch_force_n = 0.0, youngs_modulus_kpa = 0.0;
  std::optional<double> registration_rmse_mm;  ///< absent: `register` refused, or was not reached
  std::optional<std::vector<std::string>> unlike;  ///< covariates outside the calibration's range; absent: no forecast
  std::string ended_at;                        ///< the step before the first cut that refused; empty: none did
  std::vector<std::string> commands;
};

/// Returns the value at a JSON pointer ("/a/b"); null if there is none.
[[nodiscard]] nlohmann::ordered_json json_part(const nlohmann::ordered_json& json, const char* pointer);

/// Returns every step that refused this specimen or a cut of it.
[[nodiscard]] std::vector<std::string> refusals_of(const Trial& trial);

/// The test specimens that were cut twice, and the effect of the correction on them.
struct TrialSummary {
  std::size_t specimens = 0;  ///< all with that role
  std::size_t pairs = 0;      ///< specimens with two closed rings
  std::size_t opened = 0;  ///< a closed ring as planned; after the second cut open or not found. Counts as worse
  std::size_t uncorrected = 0;                       ///< a closed ring as planned; a step refused the second cut
  double mean_before_mm = 0.0, mean_after_mm = 0.0;  ///< mean over specimens of the mean absolute error
  double gain_percent = 0.0;
  double gain_percent_of_all = 0.0;  ///< including the uncorrected ones, whose error is unchanged
  std::size_t worse = 0;             ///< specimens whose error grew, and those that opened
  double most_worse_mm = 0.0;        ///< greatest increase of an error; 0: none increased
};
/// Values of the pairs are null if there are none.
inline void describe(Visitor& v, TrialSummary& s) {
  const auto if_pairs = [&s](double value) { return s.pairs > 0 ? std::optional(value) : std::nullopt; };
  v("specimens", s.specimens, "All specimens with that role.");
  v("pairs", s.pairs, "Specimens with two closed rings.");
  v("opened", s.opened, "Specimens with a closed ring as planned, whose second ring was open or not found.");
  v("uncorrected", s.uncorrected, "Specimens with a closed ring as planned and no second cut.");
  v.derived("mean_before_mm", if_pairs(s.mean_before_mm), "Mean absolute error as planned, mean over the pairs.");
  v.derived("mean_after_mm", if_pairs(s.mean_after_mm), "The same of the second cut.");
  v.derived("gain_percent", if_pairs(s.gain_percent), "Reduction of the mean error, over the pairs.");
  v.derived("gain_percent_of_all", if_pairs(s.gain_percent_of_all),
            "The same with the uncorrected specimens, whose error is unchanged.");
  v("worse", s.worse, "Specimens whose error grew or whose ring opened.");
  v({"most_worse_mm", "Greatest increase of an error; 0: none increased.", "mm"}, s.most_worse_mm);
}
/// Summarises the specimens with that role: as planned against the corrected cut, or against the cut along another
/// path. Zeros without pairs.
[[nodiscard]] TrialSummary summary_of(const std::vector<Trial>& trials, TrialRole role,
                                      std::optional<RivalPath> path = std::nullopt);

/// Returns a name for results of a forecast from the first photographs: "learned_4".
[[nodiscard]] std::string learning_name(RivalPath path, std::size_t photographs);

/// Returns the cut along a path; null: it was not requested.
[[nodiscard]] const TrialCut* find_rival(const Trial& trial, RivalPath path);

/// Returns the photograph's mean |error|, mm; absent: no closed ring was measured.
[[nodiscard]] std::optional<double> mean_error_mm(const TrialCut& cut);
/// Returns the error that remains if the planner knows the bench's physics, for the pairs of summary_of: `specimens`,
/// `mean_after_mm` (from the truth, not from photographs).
[[nodiscard]] nlohmann::ordered_json known_physics_json(const std::vector<Trial>& trials);

/// Returns one row per cut: our version of the paper's Table II.
[[nodiscard]] nlohmann::ordered_json table_2_json(const std::vector<Trial>& trials);
/// Returns, by specimen, the output of `incise assess` and whether the corrected cut was worse.
[[nodiscard]] nlohmann::ordered_json assessments_json(const std::vector<Trial>& trials);
void write_table_2(const std::filesystem::path& file, const std::vector<Trial>& trials);

/// Returns a cell for a reader, empty for null. @param column  its name, which distinguishes a score or share from a
/// length.
[[nodiscard]] std::string cell(const nlohmann::ordered_json& value, std::string_view column);

}  // namespace incise::laboratory
