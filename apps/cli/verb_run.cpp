#include "study_run.hpp"
#include "verdict_gate.hpp"

namespace incise::cli {

void add_run(Application& application) {
  auto [verb, a] = application.add_verb<CaseArguments>(
      "run",
      "The whole loop on your case: CT, mesh, stretch, plan, cut, correct, cut again, program, report. Resumes an "
      "interrupted run",
      "incise run my_patient -o my_patient/out", [](const CaseArguments& arguments, const CommonOptions& options) {
        require_accepted_ids(arguments.cut.accepted);
        return run_whole_loop(arguments, output_of(arguments.case_path, options), options);
      });
  add_case(*verb, a.case_path);
  add_cut_options(*verb, a.cut);
  add_compensation_method(*verb, a.cut);
  add_accept(*verb, a.cut.accepted);
}

}  // namespace incise::cli
