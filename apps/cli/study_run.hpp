#pragma once

#include "options.hpp"

#include <incise/steps/case_steps.hpp>

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

/// The case, and the files that it names looked for, with what the command line says in place of the case.
[[nodiscard]] CaseFile case_as_asked(const std::filesystem::path& case_path, const CutOptions& cut);

/// The case as asked, its output, and how far it is run.
[[nodiscard]] steps::CaseRequest case_request(const std::filesystem::path& case_path, Stage until,
                                              const CommonOptions& options, const CutOptions& cut);

/// Where the results of a case go when -o is not given: `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options);

/// The whole loop with program and report: what `run` and `demo` do. @returns the exit status.
int run_whole_loop(const std::filesystem::path& case_path, const std::filesystem::path& output,
                   const CommonOptions& options, const CutOptions& cut);

}  // namespace incise::cli
