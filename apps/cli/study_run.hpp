#pragma once

#include "options.hpp"

#include <incise/steps/case_steps.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise::cli {

/// Options of the verbs that cut, beside the common ones.
struct CutOptions {
  std::optional<int> frames;    ///< --frames: replaces the case's cut.frames
  bool must_resume = false;     ///< --resume: continue from a checkpoint or not at all
  double checkpoint_s = 30.0;   ///< --checkpoint-s: least wall time between two checkpoints
  std::optional<CompensationMethod> method = std::nullopt;  ///< --method: replaces the case's compensation.method
  std::vector<std::string> accepted = {};  ///< --accept: cautions that a person accepts
};
/// Options of a verb on a case.
struct CaseArguments {
  std::filesystem::path case_path;
  CutOptions cut = {};
};
/// Adds the case to a verb that writes beside it unless -o is given, see output_of.
CLI::Option* add_case(CLI::App& verb, std::filesystem::path& case_path);
/// Adds these options to a verb; `options` receives the given values.
void add_cut_options(CLI::App& verb, CutOptions& options);
/// Adds --method to a verb that corrects the path.
void add_compensation_method(CLI::App& verb, CutOptions& options);

/// Reads the case, checks that the files it names exist, and replaces settings that the command line gives. Returns the
/// case, its output, and the last stage to run.
[[nodiscard]] steps::CaseRequest case_request(const CaseArguments& arguments, Stage until,
                                              const CommonOptions& options);

/// Returns the folder for the results of a case: -o, else `out/` beside the case file.
[[nodiscard]] std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options);

/// Runs the whole loop with program and report, for `run` and `demo`. @returns the exit status.
int run_whole_loop(const CaseArguments& arguments, const std::filesystem::path& output, const CommonOptions& options);

}  // namespace incise::cli
