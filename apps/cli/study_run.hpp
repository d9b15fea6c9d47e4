#pragma once

#include "options.hpp"

#include <incise/io/folder_lock.hpp>
#include <incise/workflow/study.hpp>

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

/// One way through a study on a folder: the stages up to `until`, and a study.json in the folder that says which case it is of.
struct StudyRun {
  /// @param until  the last stage that will be asked for.
  StudyRun(const std::filesystem::path& case_path, const std::filesystem::path& output, Stage until, const CommonOptions& options,
           const CutOptions& cut = {});

  Study run(const CommonOptions& options, Monitor& monitor);

  const bool is_new_folder;  ///< the output did not exist before

 private:
  std::optional<FolderLock> lock_;  ///< on the output, before the folder is looked at

 public:
  RunFolder folder;

 private:
  const RunOptions options_;
  /// A study that failed before its first product leaves no folder behind.
  void remove_if_nothing_was_made() const;
};

/// The case, and the files that it names looked for, before anything is written. @throws CaseError, DataError
[[nodiscard]] CaseFile case_with_inputs(const std::filesystem::path& case_path);

/// The same with what the command line says in place of the case.
[[nodiscard]] CaseFile case_as_asked(const std::filesystem::path& case_path, const CutOptions& cut);

/// Where the results of a case go when -o is not given: `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options);

/// 4 where the verdict refuses the cut, else that of the outcome.
[[nodiscard]] int status_of(const Study& study);

/// The whole loop with program and report; the JSON summary of `run` and `demo`.
/// @returns the exit status; `result` receives the summary.
/// @param accepted  ids of cautions, see --accept.
int run_whole_loop(StudyRun& study, const CommonOptions& options, const std::vector<std::string>& accepted, Monitor& monitor,
                   nlohmann::ordered_json& result);

}  // namespace incise::cli
