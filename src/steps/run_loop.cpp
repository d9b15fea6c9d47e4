#include <incise/io/json_file.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/steps/compensation_figures.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/steps/run_report.hpp>
#include <incise/storage/run_files.hpp>

#include <string>
#include <vector>

namespace incise::steps {
namespace {

/// Passes everything to another monitor, and keeps the warnings for the report.
class WarningsKept : public Monitor {
 public:
  explicit WarningsKept(Monitor& outer) : outer_(outer) {}
  void message(Severity severity, std::string_view text) override {
    if (severity == Severity::Warning) warnings_.emplace_back(text);
    outer_.message(severity, text);
  }
  void progress(std::string_view stage, double fraction) override { outer_.progress(stage, fraction); }
  [[nodiscard]] bool is_cancelled() const override { return outer_.is_cancelled(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Monitor& outer_;
  std::vector<std::string> warnings_;
};

void keep_warnings(const std::filesystem::path& folder, const std::vector<std::string>& warnings) {
  const std::filesystem::path record = folder / "study.json";
  nlohmann::ordered_json study = read_json(record);
  study["warnings"] = warnings;
  write_json(record, study);
}

}  // namespace

StepResult run_loop(const CaseRequest& request, const std::vector<std::string>& accepted, const StepContext& context,
                    const std::function<void(const Run&)>& on_run) {
  CaseRun run(request.file, request.output, request.options, context.run);
  WarningsKept monitor(context.monitor);
  const Run done = run.run(accepted, context.workers, monitor);
  if (done.program) report_gate(done.verdict, done.gate, context.monitor);
  StepResult result{write_run(run.folder, done, context.wall_s(),
                              [](const std::filesystem::path& folder, const CheckedProgram& made) {
                                write_replay_figure(folder, *made.replay);
                              })};
  keep_warnings(request.output, monitor.warnings());
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
