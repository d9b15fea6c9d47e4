#include "options.hpp"
#include "study_report.hpp"

#include <memory>

namespace incise::cli {

void add_report(Application& application) {
  auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* verb = application.add_verb(
      "report", "Draw the report of a study's folder anew", "incise report demo -o demo/report.html", [folder](const CommonOptions& options) {
        Console console(options.level());
        const std::filesystem::path output = options.output.empty() ? *folder / "report.html" : options.output;
        write_report_and_figures(study_report(*folder, console), output);
        print_result(options, {{"report", output.string()}});
        return kDone;
      });
  verb->add_option("folder", *folder, "A folder made by run, demo, simulate, …")->required();
}

}  // namespace incise::cli
