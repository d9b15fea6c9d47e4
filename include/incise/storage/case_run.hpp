#pragma once

#include <incise/core/error.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/storage/run_folder.hpp>
#include <incise/workflow/run.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace incise {

/// A person asked to stop and something is kept, by default the finished stages; after a plain Cancelled nothing is.
class StagesKept : public Cancelled {
 public:
  explicit StagesKept(const std::string& what, const std::string& kept = "the stages that were finished are kept")
      : Cancelled(what + "; " + kept + ", run the same command to go on") {}
};

/// A case, and the files that it names looked for, before anything is written. @throws CaseError, DataError
[[nodiscard]] CaseFile read_case_with_inputs(const std::filesystem::path& file_or_folder);

/// Where the results of a case go by default: `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_beside(const std::filesystem::path& file_or_folder);

/// One way through the loop on a folder, which no other run may write into meanwhile: the stages up to
/// `options.until`, and a `study.json` in the folder that says which case it is of.
class CaseRun {
 public:
  /// @param output  made if missing; where it is there, its own files have to be of an earlier run.
  /// @throws DataError where the folder is somebody else's, in use, or cannot be made; CaseError for the root of all
  /// files.
  CaseRun(CaseFile file, const std::filesystem::path& output, const RunOptions& options = {},
          const RunContext& context = {});

  /// Runs the stages up to `options.until`. A run that fails before its first product leaves no folder behind.
  /// @throws CaseError naming the case's file, DataError; StagesKept or Cancelled when the monitor asks to stop.
  [[nodiscard]] Study study(Workers& workers, Monitor& monitor);
  /// Runs all of them, and makes and checks the robot program (see incise::run). @throws likewise.
  [[nodiscard]] Run run(std::span<const std::string> accepted, Workers& workers, Monitor& monitor);

  const bool is_new_folder;  ///< the output did not exist before

 private:
  std::optional<FolderLock> lock_;  ///< on the output, before the folder is looked at

 public:
  RunFolder folder;

 private:
  template <class Work>
  auto guarded(Monitor& monitor, const Work& work) -> decltype(work());
  /// A run that failed before its first product leaves no folder behind.
  void remove_if_nothing_was_made() const;
  const RunOptions options_;
};

/// From a case to the checked robot program, on every thread of the machine and without messages. The output folder
/// gets what `incise run` writes but for figures and report; what it has already is not computed again.
/// @param case_path  case.yaml, or its folder.  @param accepted  ids of the cautions that a person takes on them.
/// @throws as CaseRun.
[[nodiscard]] Run run_case(const std::filesystem::path& case_path, const std::filesystem::path& output,
                           std::span<const std::string> accepted = {});

}  // namespace incise
