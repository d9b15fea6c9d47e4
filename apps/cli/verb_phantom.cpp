#include "option_checks.hpp"
#include "options.hpp"

#include <incise/laboratory/bench_steps.hpp>

namespace incise::cli {

void add_phantom(Application& application) {
  auto [verb, a] = application.add_verb<laboratory::PhantomRequest>(
      "phantom", "Make a virtual specimen: the CT of a porcine-tongue-like body with a tumour edge, and a case file",
      "incise phantom --seed 7 --format nrrd -o specimen7",
      [](laboratory::PhantomRequest request, const CommonOptions& options) {
        request.output = options.required_output("specimen");
        return run_step(options, [&](const auto& context) { return laboratory::make_phantom_case(request, context); });
      });
  add_choice(*verb, "--format", a.form, "Format of the CT");
}

}  // namespace incise::cli
