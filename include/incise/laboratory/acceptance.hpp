#pragma once

#include <incise/core/describe.hpp>
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

/// The cuts by which a laboratory is accepted or refused.
struct AcceptanceSettings {
  std::uint64_t specimens = 24;  ///< 1 to 200; one series, its seeds counting up from the run's
  second_bench::Factors factors = second_bench::all_factors();  ///< factors that vary
  std::optional<double> speed_mm_s;                             ///< of every cut, 1 to 15; absent: as prescribed
  std::optional<double> power_w;                                ///< of every cut, 1 to 120; absent: as prescribed
  std::vector<std::string> overrides;  ///< failed checks of the program to override, see ExportRequest
  bool with_paper_pass = true;  ///< cut each specimen also along the paper's correction
  int tets = 25000;             ///< target number of tets of the planner's meshes, above 0
};
void describe(Visitor& v, AcceptanceSettings& s);

/// Cuts specimens of the second laboratory as planned and along the paper's single correction (its tool, its pass, the
/// stiffness of each specimen from its pull), and measures the photographs. Nothing is calibrated, and only the paper's
/// method corrects. So the laboratory is judged without the planner that it will judge. Finished steps are kept in each
/// specimen's cache/ and not run again.
///
///   S1/ …  as of an experiment;  truth/  the specimens;  acceptance.json  acceptance.csv  manifest.json  bench.json
///
/// @returns the content of acceptance.json: `rows`, one per specimen, and `summary`.
/// @throws InvalidArgument for settings out of their ranges; DataError for a folder with other files or another seed,
/// or where a file cannot be written; Cancelled.
[[nodiscard]] nlohmann::ordered_json accept_bench(const AcceptanceSettings& settings,
                                                  const std::filesystem::path& output, const RunContext& run,
                                                  Workers& workers, Monitor& monitor);

}  // namespace incise
