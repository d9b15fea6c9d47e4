#include "study_run.hpp"
#include "verdict_gate.hpp"

#include <memory>

namespace incise::cli {

void add_run(Application& application) {
  auto case_path = std::make_shared<std::filesystem::path>();
  auto cut = std::make_shared<CutOptions>();
  CLI::App* verb = application.add_verb(
      "run",
      "The whole loop on your case: CT, mesh, stretch, plan, cut, correct, cut again, program, report. Resumes an "
      "interrupted run",
      "incise run my_patient -o my_patient/out", [case_path, cut](const CommonOptions& options) {
        require_accepted_ids(cut->accepted);
        return run_whole_loop(*case_path, output_of(*case_path, options), options, *cut);
      });
  describe_output(*verb, kBesideCase);
  verb->add_option("case", *case_path, "Case file, or a folder with case.yaml")->required();
  add_cut_options(*verb, *cut);
  add_compensation_method(*verb, *cut);
  add_accept(*verb, cut->accepted);
}

}  // namespace incise::cli
