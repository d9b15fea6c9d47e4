#pragma once

#include <incise/storage/folder_store.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Finished scenario cuts as files, one each: `FOLDER/<first 16 digits of the key>.json`. The key is the hash of
/// everything that determines the cut: the case with all its inputs, the version, the tissue and the path. So a run is
/// found again whatever calibration or verb asks for it, and one made from other inputs is not.
class ScenarioRunFolder : public ScenarioRunStore {
 public:
  /// @param folder    is made when the first run is saved.
  /// @param case_key  the hash of the case (FolderStore::product_key of the cut as planned).
  ScenarioRunFolder(std::filesystem::path folder, std::string case_key);

  /// A damaged or changed file is reported and treated as missing: the run is simulated again and replaces it.
  std::optional<ScenarioRun> load(const RunSetting& setting, const ToolPath& path, Monitor& monitor) override;
  void save(const ScenarioRun& run, const ToolPath& path) override;

  /// Where a run is or would be.
  [[nodiscard]] std::filesystem::path file_of(const RunSetting& setting, const ToolPath& path) const;

 private:
  [[nodiscard]] std::string key_of(const RunSetting& setting, const ToolPath& path) const;
  std::filesystem::path folder_;
  std::string case_key_;
};

/// `expected_abs_error_mm`, `p_close_margin`, `unmeasured_weight`.
[[nodiscard]] nlohmann::ordered_json to_json(const PathRisk& risk);
/// The tissues that were simulated, their spread, the specimen's reference stiffness and the residual about them.
[[nodiscard]] nlohmann::ordered_json scenarios_json(const ScenarioSet& scenarios, const RobustSettings& settings);
/// What a person wants of it: outcome, the three paths' risks, the scenarios.
[[nodiscard]] nlohmann::ordered_json robust_summary_json(const RobustCorrection& robust);

/// Writes `OUT/robust/` of a study: path.json, path.vtp, robust.json, manifest.json; all or nothing.
/// @param calibration  the file that the scenarios are of.
void write_robust(FolderStore& store, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s);

/// `advice`, `reasons`, `notes`, `expected_gain_mm {mean, sd}`, `p_worse`, `p_worse_if_alike`, `p_worse_if_unlike`,
/// `p_unlike`, `p_close_margin {intended, corrected}`, both paths' risks, `registration`, `distances`, `sensitivity`,
/// `scenarios`, `rules`.
[[nodiscard]] nlohmann::ordered_json to_json(const Assessment& assessment, const AssessmentRequest& request);

/// Writes `OUT/assessment/` of a study: assess.json, manifest.json; all or nothing.
void write_assessment(FolderStore& store, const nlohmann::ordered_json& assessment,
                      const std::filesystem::path& calibration, const std::filesystem::path& registration,
                      double wall_s);

}  // namespace incise
