#pragma once

#include "options.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>

namespace incise::cli {

/// What `incise experiment` is asked for.
struct ExperimentSettings {
  std::uint64_t specimens = 4;           ///< half to calibrate on, half to test; even
  std::optional<std::uint64_t> outside;  ///< further ones, unlike the others; absent: one with four specimens, else none
  std::filesystem::path truth;           ///< empty: truth/ in the output
  bool is_quick = false;                 ///< without Table I
  bool with_paper_pass = false;          ///< test specimens are cut along the paper's single correction, too
  bool with_known_physics = false;       ///< and along that of a planner that knows the bench's physics
  bool with_withheld_force = false;      ///< advice is asked for once more without the pull
  int tets = 25000;                      ///< of the planner's meshes
};

/// The whole experiment: specimens are cut as planned, the simulation is calibrated to their photographs, further ones
/// are cut as planned and corrected, and everything is measured and written to the output. What was finished before is
/// not run again (see StepRunner). Specimens go side by side, one thread each.
/// @returns what is printed; also `study.json`.
/// @throws DataError where a command fails, or nothing is left to calibrate on; Cancelled.
[[nodiscard]] nlohmann::ordered_json run_experiment(const ExperimentSettings& settings, const CommonOptions& options,
                                                    Console& console);

}  // namespace incise::cli
