#include "options.hpp"
#include "phantom_case.hpp"

#include <memory>

namespace incise::cli {

void add_phantom(Application& application) {
  auto format = std::make_shared<std::string>("dicom");
  CLI::App* verb = application.add_verb(
      "phantom", "Make a virtual specimen: the CT of a porcine-tongue-like body with a tumour edge, and a case file",
      "incise phantom --seed 7 --format nrrd -o specimen7", [format](const CommonOptions& options) {
        Console console(options.level());
        const auto made = write_phantom_case(options.required_output("specimen"), options.seed, *format, console);
        print_result(options, made);
        return kDone;
      });
  verb->add_option("--format", *format, "Format of the CT")->check(CLI::IsMember({"dicom", "nrrd", "nifti"}));
}

}  // namespace incise::cli
