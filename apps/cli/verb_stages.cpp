#include "study_run.hpp"

namespace incise::cli {
namespace {

/// Adds a verb that runs the loop up to a stage; one that cuts has the options of a cut.
void add_stage(Application& application, const char* name, const char* what, const char* example, Stage stage) {
  auto [verb, a] = application.add_verb<CaseArguments>(
      name, what, example, [stage](const CaseArguments& arguments, const CommonOptions& options) {
        return run_step(
            options,
            [&](const auto& context) { return steps::run_stages(case_request(arguments, stage, options), context); },
            stage == Stage::Simulate ? print_cut : nullptr);
      });
  add_case(*verb, a.case_path);
  if (stage == Stage::Simulate) add_cut_options(*verb, a.cut);
}

}  // namespace

void add_stages(Application& application) {
  add_stage(application, "deform",
            "Clamp and stretch the tissue: static equilibrium under the case's constraints. An interrupted stretch is "
            "not kept: run again, it starts over and gives the same result, bit for bit",
            "incise deform specimen -o out", Stage::Stretch);
  add_stage(application, "plan", "", "incise plan specimen -o out", Stage::Plan);
  add_stage(application, "simulate",
            "Cut along the planned path (or the case's own) and measure the result. If interrupted, it leaves "
            "a checkpoint; run again, it continues from there and gives the same result, bit for bit",
            "incise simulate specimen -o out", Stage::Simulate);
}

}  // namespace incise::cli
