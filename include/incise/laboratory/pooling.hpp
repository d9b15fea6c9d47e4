#pragma once

#include <incise/core/monitor.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

namespace incise {

/// Pools experiments on the virtual bench, each a series with its own calibration: every path against the best one
/// without a simulated cut, on all test specimens and on those unlike their calibration; the advice against the
/// outcome; the robust path against the default correction. No cut is made or simulated again.
///
///   pooled.json  paths.csv  paths.svg  learning.svg (if the experiments also learned from parts of their calibrations)
///   roc.svg (if there is an area)  reliability.svg  manifest.json
///
/// @param experiments  folders of `experiment`, two or more; they are not changed.
/// @returns the content of pooled.json. @throws DataError for a folder without a finished experiment of this version,
/// for experiments on different benches, with specimens of the same seed, or along different paths; InvalidArgument for
/// fewer than two.
[[nodiscard]] nlohmann::ordered_json pool_experiments(const std::vector<std::filesystem::path>& experiments,
                                                      const std::filesystem::path& output, const RunContext& run,
                                                      Monitor& monitor);

}  // namespace incise
