#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// What an experiment on a virtual bench is asked for.
struct ExperimentSettings {
  int bench = 1;  ///< the laboratory: 1 or 2; the specimens of the second are one series, that of the seed
  std::uint64_t specimens = 4;  ///< half to calibrate on, half to test; even
  /// Further ones, unlike the others; absent: on the first bench one with four specimens, else none.
  std::optional<std::uint64_t> outside;
  std::filesystem::path truth;       ///< empty: truth/ in the output
  bool is_quick = false;             ///< without Table I
  /// Test specimens are cut along every rival's path, too: without that no benefit of simulation can be claimed.
  bool with_rivals = true;
  bool with_paper_pass = false;      ///< without the rivals: still the paper's single correction
  bool with_known_physics = false;   ///< and along that of a planner that knows the bench's physics
  bool with_withheld_force = false;  ///< advice is asked for once more without the pull
  /// Test specimens are also cut along the forecasts of only the first so many photographs: each 1 or more, ascending;
  /// those that are not fewer than all are left out. With the rivals alone.
  std::vector<std::size_t> learning;
  std::vector<std::string> overrides;  ///< checks of every program that are taken on, as of ExportRequest
  int tets = 25000;                  ///< of the planner's meshes
  CutRule rule = CutRule::Tets;      ///< of the planner's simulated cuts
};

/// The whole experiment: specimens are cut as planned, the simulation is calibrated to their photographs, further ones
/// are cut as planned and corrected, and everything is measured and written to a folder. Specimens go side by side, one
/// thread each. Steps that were finished before are not run again: each folder's `cache/` holds them, under the
/// contents of what they are made from, as long as nothing that they wrote has changed since.
///
///   S1/ …         of a specimen: lab/ (readings), planned/, compensated/, photographs, cache/, log.txt
///   truth/        the specimens themselves; nothing that plans a cut is given it
///   calibration/  calibration_N/ (of the first N photographs)  table_1/  comparison/  advice/
///   table_2.csv  commands.sh  study.json  report.html  manifest.json  experiment.json
///
/// @param run  what the manifests say; `seed` is that of the first specimen.
/// @returns what study.json holds.
/// @throws InvalidArgument for settings out of their ranges; CaseError for outside specimens or known physics on the
/// second bench, which has neither, or for learning without rivals; DataError where
/// nothing is left to calibrate on or a file cannot be written; Cancelled: finished steps are kept.
[[nodiscard]] nlohmann::ordered_json experiment(const ExperimentSettings& settings, const std::filesystem::path& output,
                                                const RunContext& run, Workers& workers, Monitor& monitor);
/// The same on every thread of the machine and without messages.
[[nodiscard]] nlohmann::ordered_json experiment(const ExperimentSettings& settings, const std::filesystem::path& output,
                                                std::uint64_t seed = 1);

}  // namespace incise
