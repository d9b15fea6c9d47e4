#include "study_run.hpp"

#include "compensation_figures.hpp"
#include "replay_files.hpp"
#include "study_report.hpp"
#include "verdict_gate.hpp"

#include <incise/storage/run_files.hpp>

namespace incise::cli {
namespace {

constexpr int kMostFrames = 500;               // as in the case file
constexpr double kLongestCheckpointS = 86400;  // a day

}  // namespace

std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options) {
  if (!options.output.empty()) return options.output;
  return (std::filesystem::is_directory(case_path) ? case_path : case_path.parent_path()) / "out";
}

void add_cut_options(CLI::App& verb, CutOptions& options) {
  verb.add_option("--frames", options.frames, "Moments of the cut to keep for pictures, in place of the case's cut.frames")
      ->check(CLI::Range(1, kMostFrames));
  verb.add_flag("--resume", options.must_resume,
                "Go on from the checkpoint of an interrupted cut, or refuse. Without it the cut goes on, too, where there is one that fits");
  verb.add_option("--checkpoint-s", options.checkpoint_s, "Seconds between two checkpoints of a cut; Ctrl-C always writes one")
      ->check(CLI::Range(0.0, kLongestCheckpointS));
}

CaseFile case_as_asked(const std::filesystem::path& case_path, const CutOptions& cut) {
  CaseFile file = read_case_with_inputs(case_path);
  if (cut.frames) file.settings.frames = *cut.frames;
  if (cut.method) file.settings.compensation.method = *cut.method;
  return file;
}

StudyRun::StudyRun(const std::filesystem::path& case_path, const std::filesystem::path& output, Stage until,
                   const CommonOptions& options, const CutOptions& cut)
    : CaseRun(case_as_asked(case_path, cut), output, {until, cut.must_resume, cut.checkpoint_s}, options.context()),
      threads_(options.threads) {}

Study StudyRun::study(Monitor& monitor) {
  Workers workers(threads_);
  return CaseRun::study(workers, monitor);
}

Run StudyRun::run(const std::vector<std::string>& accepted, Monitor& monitor) {
  Workers workers(threads_);
  return CaseRun::run(accepted, workers, monitor);
}

int status_of(const Study& study, const Verdict& verdict) {
  return verdict.status() == VerdictStatus::Refused && study.outcome != Outcome::Cancelled ? kNotAcceptable
                                                                                           : status_of(study.outcome);
}

int run_whole_loop(const std::filesystem::path& case_path, const std::filesystem::path& output,
                   const CommonOptions& options, const CutOptions& cut, Console& console) {
  StudyRun study(case_path, output, Stage::Verify, options, cut);
  const Run done = study.run(cut.accepted, console);
  if (done.program) report_gate(done.verdict, done.gate, console);
  nlohmann::ordered_json result = write_run(study.folder, done, options.wall_s(),
                                            [](const std::filesystem::path& folder, const CheckedProgram& made) {
                                              write_replay_figure(folder, *made.replay);
                                            });
  console.message(Severity::Notice, "report: drawing");
  try {
    write_report_and_figures(study_report(output, console), output / "report.html");
    write_compensation_figures(output, output / "figures");
  } catch (const Cancelled& error) {
    throw StagesKept(error.what());
  }
  result["report"] = (output / "report.html").string();
  result["wall_s"] = options.wall_s();
  print_study(options, result);
  const bool lacks_program = done.study.plan && study.folder.case_file().settings.T_robot_sim && !done.gate.is_open;
  return lacks_program ? kNotAcceptable : status_of(done.study, done.verdict);
}

}  // namespace incise::cli
