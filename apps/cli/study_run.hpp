#pragma once

#include "options.hpp"

#include <incise/storage/case_run.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise::cli {

/// What the verbs that cut understand beside the common options.
struct CutOptions {
  std::optional<int> frames;    ///< --frames: in place of the case's cut.frames
  bool must_resume = false;     ///< --resume: go on from a checkpoint or not at all
  double checkpoint_s = 30.0;   ///< --checkpoint-s: least wall time between two checkpoints
  std::optional<CompensationMethod> method = std::nullopt;  ///< --method: in place of the case's compensation.method
  std::vector<std::string> accepted = {};  ///< --accept: cautions that a person takes on them
};
/// Adds them to a verb; `options` receives what is given.
void add_cut_options(CLI::App& verb, CutOptions& options);
/// Adds --method to a verb that corrects the path.
void add_compensation_method(CLI::App& verb, CutOptions& options);

/// A run of a case up to a stage, with what the command line says in place of the case.
class StudyRun : public CaseRun {
 public:
  /// @param until  the last stage that will be asked for.
  StudyRun(const std::filesystem::path& case_path, const std::filesystem::path& output, Stage until,
           const CommonOptions& options, const CutOptions& cut = {});
  [[nodiscard]] Study study(Monitor& monitor);
  [[nodiscard]] Run run(const std::vector<std::string>& accepted, Monitor& monitor);

 private:
  const int threads_;
};

/// The case, and the files that it names looked for, with what the command line says in place of the case.
[[nodiscard]] CaseFile case_as_asked(const std::filesystem::path& case_path, const CutOptions& cut);

/// Where the results of a case go when -o is not given: `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options);

/// 4 where the verdict refuses the cut, else that of the outcome.
[[nodiscard]] int status_of(const Study& study, const Verdict& verdict);

/// The whole loop with program and report: what `run` and `demo` do. @returns the exit status.
int run_whole_loop(const std::filesystem::path& case_path, const std::filesystem::path& output,
                   const CommonOptions& options, const CutOptions& cut, Console& console);

}  // namespace incise::cli
