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

/// What a step from files to files is given beside its request.
struct StepContext {
  RunContext run;  ///< what the manifests of its results say
  Workers& workers;
  Monitor& monitor;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  [[nodiscard]] double wall_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

/// What came of a step that ran to its end.
struct StepResult {
  nlohmann::ordered_json json;  ///< what `--json` prints
  bool is_acceptable = true;    ///< else nothing can be done with what it found
};

/// The manifest of what a step without a case makes. The specimen is the one that all inputs state, if they do. Empty
/// names among the inputs: not given. @throws DataError for an input that cannot be read.
[[nodiscard]] Manifest manifest_of(const RunContext& run, std::string settings_json,
                                   const std::vector<std::filesystem::path>& inputs, double wall_s);

/// Makes the folder that an output folder is to lie in. Empty: nothing. @throws DataError if it cannot be made, or the
/// output is there already and is somebody else's.
void make_parent(const std::filesystem::path& folder);

/// Each reason as a warning.
void report_reasons(const Verdict& verdict, Monitor& monitor);

}  // namespace incise::steps
