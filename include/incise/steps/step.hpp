#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace incise::steps {

/// Context of a step, beside its request.
struct StepContext {
  RunContext run;  ///< command, seed and threads for the manifests
  Workers& workers;
  Monitor& monitor;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  [[nodiscard]] double wall_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

/// Result of a step that ran to its end.
struct StepResult {
  nlohmann::ordered_json json;  ///< output of `--json`
  bool is_acceptable = true;    ///< false: the result is of no use
};

/// Returns the manifest of a step without a case. Its specimen is the one that the inputs state, if they agree.
/// @param inputs  files; empty paths are skipped. @throws DataError for an input that cannot be read.
[[nodiscard]] Manifest manifest_of(const RunContext& run, std::string settings_json,
                                   const std::vector<std::filesystem::path>& inputs, double wall_s);

/// Makes the parent folder of an output folder. Does nothing for an empty path. @throws DataError if it cannot be made,
/// or if the output exists and is not incise's own.
void make_parent(const std::filesystem::path& folder);

/// Reports each reason as a warning.
void report_reasons(const Verdict& verdict, Monitor& monitor);

}  // namespace incise::steps
