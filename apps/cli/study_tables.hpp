#pragma once

#include "study_specimen.hpp"

#include <incise/report/report_data.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::cli {

enum class TrialRole { Calibrate, Test, Outside };
[[nodiscard]] const char* to_string(TrialRole role);  ///< calibrate, test, outside

/// One specimen of an experiment, and what came of it.
struct Trial {
  std::string name;
  std::uint64_t seed = 0;
  TrialRole role = TrialRole::Calibrate;
  std::string kind;                                      ///< of a specimen outside the calibrated range; else empty
  std::vector<std::pair<std::string, double>> given;     ///< hidden parameters that are not drawn from the seed
  std::optional<TrialCut> planned, corrected;
  std::optional<TrialCut> paper_pass;                    ///< along the paper's single correction; not cut unless asked for
  nlohmann::ordered_json compensation;  ///< what `incise compensate` printed; null: not run
  nlohmann::ordered_json assessment;    ///< what `incise assess` printed; null: not run
  nlohmann::ordered_json assessment_without_pull;  ///< the same, had the pull not been measured
  nlohmann::ordered_json known_physics;            ///< what `incise bench floor` printed; null: not run
  double stretch_force_n = 0.0, youngs_modulus_kpa = 0.0, registration_rmse_mm = 0.0;
  std::string ended_at;                 ///< the step that refused; empty: none did
  std::vector<std::string> commands;
};

/// The test specimens that were cut twice, and what the correction did to them.
struct TrialSummary {
  std::size_t specimens = 0;    ///< with that role, whatever came of them
  std::size_t pairs = 0;        ///< of them: cut twice
  std::size_t uncorrected = 0;  ///< cut as planned, and refused or open where it was to be cut again
  double mean_before_mm = 0.0, mean_after_mm = 0.0;  ///< mean over specimens of the mean absolute error
  double gain_percent = 0.0;
  double gain_percent_of_all = 0.0;  ///< with the uncorrected ones, whose error stays what it was
  std::size_t worse = 0;        ///< specimens whose error grew
  double most_worse_mm = 0.0;   ///< by how much at most; 0: none
};
/// Of the specimens with that role, as planned against another cut. No pairs: zeros.
[[nodiscard]] TrialSummary summary_of(const std::vector<Trial>& trials, TrialRole role,
                                      std::optional<TrialCut> Trial::*after = &Trial::corrected);
/// The same names; what is of the pairs is null without any.
[[nodiscard]] nlohmann::ordered_json to_json(const TrialSummary& summary);
/// What is left to a planner that knows the bench's physics, of the test specimens: `specimens`, `mean_after_mm` (from
/// the truth, not from photographs).
[[nodiscard]] nlohmann::ordered_json known_physics_json(const std::vector<Trial>& trials);

/// One row a cut: the paper's Table II in our own version.
[[nodiscard]] nlohmann::ordered_json table_2_json(const std::vector<Trial>& trials);
/// By specimen, what `incise assess` said and whether its corrected cut was the worse one.
[[nodiscard]] nlohmann::ordered_json assessments_json(const std::vector<Trial>& trials);
void write_table_2(const std::filesystem::path& file, const std::vector<Trial>& trials);

/// The page with everything: tables, the comparison's figures, the calibration's, the paper's figures cited beside.
/// @param folder  of the experiment: figures are taken from there where they are.
[[nodiscard]] ReportData experiment_report(const std::vector<Trial>& trials, const nlohmann::ordered_json& result,
                                           const std::filesystem::path& folder);

}  // namespace incise::cli
