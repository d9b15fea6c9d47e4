#pragma once

#include <incise/storage/run_folder.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// `expected_abs_error_mm`, `p_close_margin`, `unmeasured_weight`.
[[nodiscard]] nlohmann::ordered_json to_json(const PathRisk& risk);
/// The tissues that were simulated, their spread, the specimen's reference stiffness and the residual about them.
[[nodiscard]] nlohmann::ordered_json scenarios_json(const ScenarioSet& scenarios, const RobustSettings& settings);
/// What a person wants of it: outcome, the three paths' risks, the scenarios.
[[nodiscard]] nlohmann::ordered_json robust_summary_json(const RobustCorrection& robust);

/// Writes `OUT/robust/` of a study: path.json, path.vtp, robust.json, manifest.json; all or nothing.
/// @param calibration  the file that the scenarios are of.
void write_robust(RunFolder& run, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s);

/// `advice`, `reasons`, `notes`, `expected_gain_mm {mean, sd}`, `p_worse`, `p_worse_if_alike`, `p_worse_if_unlike`,
/// `p_unlike`, `p_close_margin {intended, corrected}`, both paths' risks, `registration`, `distances`, `sensitivity`,
/// `scenarios`, `rules`.
[[nodiscard]] nlohmann::ordered_json to_json(const Assessment& assessment, const AssessmentRequest& request);

/// Writes `OUT/assessment/` of a study: assess.json, manifest.json; all or nothing.
void write_assessment(RunFolder& run, const nlohmann::ordered_json& assessment,
                      const std::filesystem::path& calibration, const std::filesystem::path& registration,
                      double wall_s);

}  // namespace incise
