#pragma once

#include <incise/storage/run_folder.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Writes `OUT/robust/` of a study: path.json, path.vtp, robust.json, manifest.json; all or nothing.
/// @param calibration  the file that the scenarios are of.
void write_robust(RunFolder& run, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s);

/// Writes `OUT/assessment/` of a study: assess.json, manifest.json; all or nothing.
void write_assessment(RunFolder& run, const nlohmann::ordered_json& assessment,
                      const std::filesystem::path& calibration, const std::filesystem::path& registration,
                      double wall_s);

}  // namespace incise
