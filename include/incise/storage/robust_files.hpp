#pragma once

#include <incise/storage/run_folder.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise {

/// Writes `robust/` into a run's folder: path.json, path.vtp, robust.json, manifest.json; all or nothing.
/// @param calibration  file that the scenarios come from  @throws DataError as AtomicFolder, or if it is unreadable.
void write_robust(RunFolder& run, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s);

/// Writes `assessment/` into a run's folder: assess.json, manifest.json; all or nothing.
/// @param assessment  result of `incise assess`, made from the files `calibration` and `registration`
/// @throws DataError as AtomicFolder, or if one of the two files is unreadable.
void write_assessment(RunFolder& run, const nlohmann::ordered_json& assessment,
                      const std::filesystem::path& calibration, const std::filesystem::path& registration,
                      double wall_s);

}  // namespace incise
