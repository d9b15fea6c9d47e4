#include "study_run.hpp"

#include "option_checks.hpp"

namespace incise::cli {
namespace {

constexpr int kMostFrames = 500;               // as in the case file
constexpr double kLongestCheckpointS = 86400;  // a day

}  // namespace

std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options) {
  if (!options.output.empty()) return options.output;
  return output_beside(case_path);
}

CLI::Option* add_case(CLI::App& verb, std::filesystem::path& case_path) {
  describe_output(verb, "by default `out` in the case's folder");
  return verb.add_option("case", case_path, "Case file, or a folder with case.yaml")->required();
}

void add_cut_options(CLI::App& verb, CutOptions& options) {
  verb.add_option("--frames", options.frames,
                  "Number of moments of the cut to keep for pictures; overrides the case's cut.frames")
      ->check(whole_between("--frames", 1, kMostFrames));
  verb.add_flag("--resume", options.must_resume,
                "Continue from the checkpoint of an interrupted cut, or refuse. Without --resume, the cut continues if "
                "its checkpoint fits and otherwise starts again");
  verb.add_option("--checkpoint-s", options.checkpoint_s, "Seconds between two checkpoints of a cut; Ctrl-C always writes one")
      ->check(CLI::Range(0.0, kLongestCheckpointS));
}

steps::CaseRequest case_request(const CaseArguments& arguments, Stage until, const CommonOptions& options) {
  CaseFile file = read_case_with_inputs(arguments.case_path);
  if (arguments.cut.frames) file.settings.frames = *arguments.cut.frames;
  if (arguments.cut.method) file.settings.compensation.method = *arguments.cut.method;
  if (const std::vector<Problem> problems = validate(file.settings.compensation); !problems.empty()) {
    throw CaseError("case", "compensation." + problems[0].path, problems[0].found, problems[0].expected,
                    problems[0].hint)
        .in_file(arguments.case_path.string());
  }
  return {std::move(file),
          output_of(arguments.case_path, options),
          {until, arguments.cut.must_resume, arguments.cut.checkpoint_s}};
}

int run_whole_loop(const CaseArguments& arguments, const std::filesystem::path& output, const CommonOptions& options) {
  steps::CaseRequest request = case_request(arguments, Stage::Verify, options);
  request.output = output;
  return run_step(
      options, [&](const auto& context) { return steps::run_loop(request, arguments.cut.accepted, context); },
      print_study);
}

}  // namespace incise::cli
