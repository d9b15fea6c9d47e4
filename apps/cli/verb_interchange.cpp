#include "option_checks.hpp"
#include "options.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/steps/case_steps.hpp>

namespace incise::cli {

void add_interchange(Application& application) {
  struct Arguments {
    std::filesystem::path case_path;
    std::optional<steps::InterchangeFormat> format;
  };
  auto [verb, a] = application.add_verb<Arguments>(
      "interchange", "", "incise interchange specimen --format sofa -o for_sofa",
      [](const Arguments& arguments, const CommonOptions& options) {
        const std::filesystem::path output = options.required_output("for_sofa");
        require_replaceable(output);
        const CaseFile file = read_case_with_inputs(arguments.case_path);
        refuse_input_as_output("-o", output, {file.file, file.inputs.specimen_mesh});
        return run_step(options, [&](const auto& context) {
          return steps::write_for_solver(file, *arguments.format, output, context);
        });
      });
  verb->add_option("case", a.case_path, "Case file, or a folder with case.yaml")->required();
  add_choice(*verb, "--format", a.format, "Format to write: sofa (case.scn) or febio (case.feb)")->required();
}

}  // namespace incise::cli
