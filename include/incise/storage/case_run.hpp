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

/// Thrown if a run is cancelled and something is kept, by default the finished stages. After a plain Cancelled, nothing
/// is kept.
class StagesKept : public Cancelled {
 public:
  explicit StagesKept(const std::string& what, const std::string& kept = "the finished stages are kept")
      : Cancelled(what + "; " + kept + ". Run the same command to continue") {}
};

/// Reads a case and checks that the files that it names exist. @throws as read_case and require_input_files.
[[nodiscard]] CaseFile read_case_with_inputs(const std::filesystem::path& file_or_folder);

/// Returns the default output folder of a case: `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_beside(const std::filesystem::path& file_or_folder);

/// A run of the loop on a case, with exclusive use of its output folder. Runs the stages up to `options.until`; writes
/// `study.json`, which names the case, into the folder.
class CaseRun {
 public:
  /// @param output  created if missing; otherwise its own files must be from an earlier run (see require_own_files)
  /// @throws DataError if the folder holds files from elsewhere, is in use, or cannot be made; CaseError for the root
  ///         of the file system.
  CaseRun(CaseFile file, const std::filesystem::path& output, const RunOptions& options = {},
          const RunContext& context = {});

  /// Runs the stages up to `options.until`. If it fails before its first product, a folder that it made is removed.
  /// @throws CaseError naming the case's file, DataError; StagesKept or Cancelled if the monitor asks to stop.
  [[nodiscard]] Study study(Workers& workers, Monitor& monitor);
  /// As study, and makes and checks the robot program (see incise::run), which write_run writes. On any exception but
  /// Cancelled, removes the `program/` of an earlier run.
  /// @param accepted  ids of the cautions that a person accepts  @throws as study.
  [[nodiscard]] Run run(std::span<const std::string> accepted, Workers& workers, Monitor& monitor);

  const bool is_new_folder;  ///< the output did not exist before

 private:
  std::optional<FolderLock> lock_;  ///< on the output folder; taken before `folder` reads it

 public:
  RunFolder folder;

 private:
  template <class Work>
  auto guarded(Monitor& monitor, const Work& work) -> decltype(work());
  /// Removes the output folder if this run made it and it holds nothing but study.json.
  void remove_if_nothing_was_made() const;
  const RunOptions options_;
};

/// Runs the whole loop, from a case to the checked robot program, on all threads of the machine and without messages.
/// Writes into the output folder what `incise run` writes, except figures and report; reuses results that are there.
/// @param case_path  case.yaml, or its folder  @param accepted  ids of the cautions that a person accepts
/// @throws as CaseRun.
[[nodiscard]] Run run_case(const std::filesystem::path& case_path, const std::filesystem::path& output,
                           std::span<const std::string> accepted = {});

}  // namespace incise
