#include "study_run.hpp"

#include "replay_files.hpp"
#include "study_report.hpp"

#include <incise/laboratory/compensation_figures.hpp>
#include <incise/laboratory/robot_steps.hpp>
#include <incise/storage/run_files.hpp>

namespace incise::cli {
namespace {

constexpr int kMostFrames = 500;               // as in the case file
constexpr double kLongestCheckpointS = 86400;  // a day

}  // namespace

std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options) {
  if (!options.output.empty()) return options.output;
  return output_beside(case_path);
}

void add_cut_options(CLI::App& verb, CutOptions& options) {
  verb.add_option("--frames", options.frames, "Moments of the cut to keep for pictures, in place of the case's cut.frames")
      ->check(CLI::Range(1, kMostFrames));
  verb.add_flag("--resume", options.must_resume,
                "Continue from the checkpoint of an interrupted cut, or refuse. Without --resume it continues "
                "if its checkpoint fits, and else starts again");
  verb.add_option("--checkpoint-s", options.checkpoint_s, "Seconds between two checkpoints of a cut; Ctrl-C always writes one")
      ->check(CLI::Range(0.0, kLongestCheckpointS));
}

CaseFile case_as_asked(const std::filesystem::path& case_path, const CutOptions& cut) {
  CaseFile file = read_case_with_inputs(case_path);
  if (cut.frames) file.settings.frames = *cut.frames;
  if (cut.method) file.settings.compensation.method = *cut.method;
  return file;
}

laboratory::CaseRequest case_request(const std::filesystem::path& case_path, Stage until, const CommonOptions& options,
                                     const CutOptions& cut) {
  return {case_as_asked(case_path, cut), output_of(case_path, options), {until, cut.must_resume, cut.checkpoint_s}};
}

int run_whole_loop(const std::filesystem::path& case_path, const std::filesystem::path& output,
                   const CommonOptions& options, const CutOptions& cut, Console& console) {
  const laboratory::CaseRequest asked = case_request(case_path, Stage::Verify, options, cut);
  CaseRun study(asked.file, output, asked.options, options.context());
  Workers workers(options.threads);
  const Run done = study.run(cut.accepted, workers, console);
  if (done.program) laboratory::report_gate(done.verdict, done.gate, console);
  nlohmann::ordered_json result = write_run(study.folder, done, options.wall_s(),
                                            [](const std::filesystem::path& folder, const CheckedProgram& made) {
                                              write_replay_figure(folder, *made.replay);
                                            });
  console.message(Severity::Notice, "report: drawing");
  try {
    write_report_and_figures(study_report(output, console), output / "report.html");
    laboratory::write_compensation_figures(output, output / "figures");
  } catch (const Cancelled& error) {
    throw StagesKept(error.what());
  }
  result["report"] = (output / "report.html").string();
  result["wall_s"] = options.wall_s();
  print_study(options, result);
  const bool lacks_program = done.study.plan && asked.file.settings.T_robot_sim && !done.gate.is_open;
  const bool is_refused = done.verdict.status() == VerdictStatus::Refused;
  return lacks_program || is_refused ? kNotAcceptable : status_of(done.study.outcome);
}

}  // namespace incise::cli
