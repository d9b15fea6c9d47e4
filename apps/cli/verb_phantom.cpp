#include "option_checks.hpp"
#include "options.hpp"

#include <incise/laboratory/bench_steps.hpp>

namespace incise::cli {

void add_phantom(Application& application) {
  struct PhantomArguments {
    std::string format = "dicom";
  };
  auto [verb, a] = application.add_verb<PhantomArguments>(
      "phantom", "Make a virtual specimen: the CT of a porcine-tongue-like body with a tumour edge, and a case file",
      "incise phantom --seed 7 --format nrrd -o specimen7",
      [](const PhantomArguments& arguments, const CommonOptions& options) {
        const laboratory::PhantomRequest request{value_named<laboratory::PhantomForm>(arguments.format),
                                                 options.required_output("specimen")};
        return run_step(options, [&](const auto& context) { return laboratory::make_phantom_case(request, context); });
      });
  verb->add_option("--format", a.format, "Format of the CT")->check(name_of_any<laboratory::PhantomForm>());
}

}  // namespace incise::cli
