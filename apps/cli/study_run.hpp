#pragma once

#include "options.hpp"

#include <incise/workflow/study.hpp>

namespace incise::cli {

/// One way through a study on a folder: the stages up to `until`, and a study.json in the folder that says which case it is of.
struct StudyRun {
  StudyRun(const std::filesystem::path& case_path, const std::filesystem::path& output, const CommonOptions& options);

  Study run(Stage until, const CommonOptions& options, Monitor& monitor);

  const bool is_new_folder;  ///< the output did not exist before
  FolderStore store;

 private:
  /// A study that failed before its first product leaves no folder behind.
  void remove_if_nothing_was_made() const;
  [[nodiscard]] bool has_products() const;
};

/// The case, and the files that it names looked for, before anything is written. @throws CaseError, DataError
[[nodiscard]] CaseFile case_with_inputs(const std::filesystem::path& case_path);

/// Where the results of a case go when -o is not given: `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options);

/// The whole loop with program and report; the JSON summary of `run` and `demo`.
/// @returns the exit status; `result` receives the summary.
int run_whole_loop(StudyRun& study, const CommonOptions& options, Monitor& monitor, nlohmann::ordered_json& result);

}  // namespace incise::cli
