#include <incise/steps/case_steps.hpp>
#include <incise/steps/compensation_figures.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/steps/run_report.hpp>
#include <incise/storage/run_files.hpp>

namespace incise::steps {

StepResult run_loop(const CaseRequest& request, const std::vector<std::string>& accepted, const StepContext& context,
                    const std::function<void(const Run&)>& on_run) {
  CaseRun run(request.file, request.output, request.options, context.run);
  const Run done = run.run(accepted, context.workers, context.monitor);
  if (done.program) report_gate(done.verdict, done.gate, context.monitor);
  StepResult result{write_run(run.folder, done, context.wall_s(),
                              [](const std::filesystem::path& folder, const CheckedProgram& made) {
                                write_replay_figure(folder, *made.replay);
                              })};
  if (on_run) on_run(done);
  context.monitor.message(Severity::Notice, "report: drawing");
  const std::filesystem::path page = request.output / "report.html";
  try {
    write_report_and_figures(run_report(request.output, context.monitor), page);
    write_compensation_figures(request.output, request.output / "figures");
  } catch (const Cancelled& error) {
    throw StagesKept(error.what());
  }
  result.json["report"] = page.string();
  result.json["wall_s"] = context.wall_s();
  const bool lacks_program = done.study.plan && request.file.settings.T_robot_sim && !done.gate.is_open;
  result.is_acceptable =
      !lacks_program && done.verdict.status() != VerdictStatus::Refused && done.study.outcome == Outcome::Success;
  return result;
}

}  // namespace incise::steps
