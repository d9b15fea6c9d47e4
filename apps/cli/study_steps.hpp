#pragma once

#include "own_process.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise::cli {

/// One command of an experiment.
struct ExperimentStep {
  std::string name;                           ///< of its record: letters, digits, _
  std::vector<std::string> arguments;         ///< of the verb, its name first; paths relative to the working folder
  std::vector<std::filesystem::path> inputs;  ///< files and folders whose content decides what comes out
  std::vector<std::filesystem::path> products;  ///< files and folders that it makes and no other step adds to; none where its JSON is all
};

/// How it ended.
struct StepRecord {
  int status = 0;
  nlohmann::ordered_json result;  ///< what it printed with --json; null where it printed nothing
  double wall_s = 0.0;            ///< when it was run
  bool is_reused = false;
};

/// Which step refused, with its own words.
[[nodiscard]] std::string refusal_of(const std::string& step, const StepRecord& record);

/// Runs the commands of one folder, each with --json --quiet. A command that has been run with the same arguments, by the
/// same executable, on inputs of the same content, and whose products are still what it made, is not run again: its record
/// (`steps/NAME.json`) is read. A damaged record counts as none.
class StepRunner {
 public:
  /// @param folder   where records and log go; it is made.  @param threads  that each command may use.
  StepRunner(std::filesystem::path folder, int threads, const Monitor& monitor);

  /// Status 0, 4 (it ran, but what came of it is not acceptable) and 2 and 3 (a case or a reading that cannot be used; not
  /// recorded, so it is run again another time) are results.
  /// @throws DataError where nothing more can be written, or naming the command and the log for every other status; Cancelled.
  StepRecord run(const ExperimentStep& step);
  /// The commands so far, in their order, as a shell would be given them.
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
  [[nodiscard]] const std::filesystem::path& log() const { return log_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path log_;
  int threads_;
  const Monitor& monitor_;
  std::vector<std::string> lines_;
};

}  // namespace incise::cli
