#pragma once

#include <incise/core/cache.hpp>
#include <incise/laboratory/laboratory.hpp>
#include <incise/steps/step.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace incise::laboratory {

/// One step of an experiment.
struct ExperimentStep {
  std::string name;                             ///< letters, digits, _
  std::vector<std::string> arguments;           ///< of the command that does the same, its verb first
  std::vector<std::filesystem::path> inputs;    ///< files and folders whose content determines the result
  std::vector<std::filesystem::path> products;  ///< files and folders that it makes and no other step adds to
  std::function<steps::StepResult(const steps::StepContext&)> work;
};

/// Which step refused, with its own words.
[[nodiscard]] std::string refusal_of(const std::string& step, const StepAnswer& answer);

/// Runs the steps of one folder. A step that ended before with the same arguments, by the same build, on inputs of the
/// same content, and whose products are still what it made, is not run again: the cache in the folder has its answer.
class ExperimentSteps {
 public:
  /// @param folder   where cache and log go; it is made.  @param monitor  is asked whether to stop; messages go to the
  /// log.
  ExperimentSteps(std::filesystem::path folder, Workers& workers, const Monitor& monitor);

  /// A case or a reading that cannot be used is an answer, which is not kept: the step is run again another time.
  /// @throws DataError where nothing more can be written; Cancelled.
  StepAnswer run(const ExperimentStep& step);
  /// The commands so far, in their order, as a shell would be given them.
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Number of steps so far for which the cache had no answer.
  [[nodiscard]] std::size_t computed() const { return computed_; }

 private:
  class LogFile;
  StepAnswer made_now(const ExperimentStep& step, LogFile& log);

  std::filesystem::path folder_;
  Workers& workers_;
  const Monitor& outer_;
  Cache cache_;
  std::vector<std::string> lines_;
  std::size_t computed_ = 0;
};

}  // namespace incise::laboratory
