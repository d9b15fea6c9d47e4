#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/second_bench/specimen.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Which cuts a laboratory is accepted or refused by.
struct AcceptanceSettings {
  std::uint64_t specimens = 24;                                 ///< their seeds count up from the run's
  second_bench::Factors factors = second_bench::all_factors();  ///< that vary
  std::optional<double> speed_mm_s;                             ///< of every cut; absent: as prescribed
  std::optional<double> power_w;                                ///< likewise
  std::vector<std::string> overrides;  ///< checks of the program that are taken on, as of ExportRequest
  bool with_paper_pass = true;  ///< and each specimen once more along the paper's correction
  int tets = 25000;             ///< of the planner's meshes
};

/// Cuts specimens of the second laboratory as planned and along the paper's single correction (its tool, its pass, each
/// specimen's stiffness by its pull), and measures the photographs. Nothing is calibrated, and nothing but the paper's
/// method corrects: what a laboratory yields is judged without the planner that it will judge. Finished steps are kept
/// in each specimen's cache/ and not run again.
///
///   S1/ …  as of an experiment;  truth/  the specimens;  acceptance.json  acceptance.csv  manifest.json  bench.json
///
/// @returns what acceptance.json holds: `rows`, one a specimen, and `summary`.
/// @throws DataError where a file cannot be written; Cancelled.
[[nodiscard]] nlohmann::ordered_json accept_bench(const AcceptanceSettings& settings,
                                                  const std::filesystem::path& output, const RunContext& run,
                                                  Workers& workers, Monitor& monitor);

}  // namespace incise
