#pragma once

#include <incise/core/monitor.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

namespace incise {

/// Experiments on the virtual bench taken together, each a series with a calibration of its own: every path against the
/// best one without a simulated cut, on all test specimens and on those unlike their calibration; the advice against
/// what happened; the robust path against the default correction. Nothing is cut or computed anew.
///
///   pooled.json  paths.csv  paths.svg  learning.svg (where parts of the calibrations were learned from)  roc.svg
///   (where there is an area)  reliability.svg  manifest.json
///
/// @param experiments  folders of `experiment`, two or more; they stay as they are.
/// @returns what pooled.json holds. @throws DataError for a folder without a finished experiment of this version, for
/// experiments of two benches, with specimens of the same seed, or along different paths; InvalidArgument for fewer
/// than two.
[[nodiscard]] nlohmann::ordered_json pool_experiments(const std::vector<std::filesystem::path>& experiments,
                                                      const std::filesystem::path& output, const RunContext& run,
                                                      Monitor& monitor);

}  // namespace incise
