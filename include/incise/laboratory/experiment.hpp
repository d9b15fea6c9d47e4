#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/problem.hpp>
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

/// Settings of an experiment on a virtual bench.
struct ExperimentSettings {
  int bench = 1;  ///< virtual laboratory, 1 or 2; specimens of the second form one series, whose number is the seed
  std::uint64_t specimens = 4;  ///< even, 2 to 200: half for calibration, half for the test
  /// Additional specimens, unlike the others, 0 to 200. Absent: one on the first bench with four specimens, else none.
  std::optional<std::uint64_t> outside;
  std::filesystem::path truth;       ///< empty: truth/ in the output
  bool is_quick = false;             ///< omit Table I
  /// Cut test specimens also along every rival's path. Without these, no benefit of simulation can be claimed.
  bool with_rivals = true;
  bool with_paper_pass = false;      ///< without the rivals: still cut along the paper's single correction
  bool with_known_physics = false;   ///< also cut along the path of a planner that knows the bench's physics
  bool with_withheld_force = false;  ///< also assess and correct as if the pull had not been measured
  /// Cut test specimens also along the forecasts from only the first so many photographs: each number 1 to 100,
  /// ascending; numbers that are not below the number of all photographs are ignored. Only with the rivals.
  std::vector<std::size_t> learning;
  std::vector<std::string> overrides;  ///< failed checks of every program to override, see ExportRequest
  int tets = 25000;                    ///< target number of tets of the planner's meshes, 5000 to 500000
  CutRule rule = CutRule::Tets;      ///< rule of the planner's simulated cuts
};
void describe(Visitor& v, ExperimentSettings& s);
/// Returns every violation; empty if valid. Outside specimens and known physics are of the first bench only: the second
/// has specimens unlike the others among its own, and no planner that knows its physics.
[[nodiscard]] std::vector<Problem> validate(const ExperimentSettings& settings);

/// Runs the whole experiment: cuts specimens as planned, calibrates the simulation to their photographs, cuts further
/// specimens as planned and corrected, measures everything and writes it to a folder. Specimens are processed side by
/// side, each in one thread. Finished steps are not run again: the `cache/` of each folder holds them under the
/// contents of their inputs, as long as none of their output files has changed.
///
///   S1/ …         of a specimen: lab/ (readings), planned/, compensated/, photographs, cache/, log.txt
///   truth/        the specimens themselves; no planner receives it
///   calibration/  calibration_N/ (of the first N photographs)  table_1/  comparison/  advice/
///   table_2.csv  commands.sh  study.json  report.html  manifest.json  experiment.json
///
/// @param run  content of the manifests; `seed` is the seed of the first specimen.
/// @returns the content of study.json.
/// @throws InvalidArgument for invalid settings; DataError where no cut is left to calibrate on or a file cannot be
/// written; Cancelled: finished steps are kept.
[[nodiscard]] nlohmann::ordered_json experiment(const ExperimentSettings& settings, const std::filesystem::path& output,
                                                const RunContext& run, Workers& workers, Monitor& monitor);
/// As above, on every thread of the machine and without messages.
[[nodiscard]] nlohmann::ordered_json experiment(const ExperimentSettings& settings, const std::filesystem::path& output,
                                                std::uint64_t seed = 1);

}  // namespace incise
