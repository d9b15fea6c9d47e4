#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/steps/run_report.hpp>
#include <incise/storage/own_files.hpp>

#include <optional>

namespace incise::cli {

void add_report(Application& application) {
  struct ReportArguments {
    std::filesystem::path folder, registration, replay;
  };
  auto [verb, a] = application.add_verb<ReportArguments>(
      "report", "", "incise report demo --registration registration --replay replay -o report.html",
      [](const ReportArguments& arguments, const CommonOptions& options) {
        Console console(options.level());
        const bool is_of_a_study = !arguments.folder.empty();
        if (!is_of_a_study && arguments.registration.empty() && arguments.replay.empty()) {
          throw CaseError("command line", "report", "no folder", "a run's folder, --registration or --replay");
        }
        const std::filesystem::path output = !options.output.empty() ? options.output
                                             : is_of_a_study         ? arguments.folder / "report.html"
                                                                     : std::filesystem::path("report.html");
        refuse_input_as_output("-o", output, {arguments.registration, arguments.replay});
        require_own_page(output);
        ReportData data;
        std::optional<FolderLock> lock;  // another run in that folder would mix older and newer results
        if (is_of_a_study) {
          if (std::filesystem::is_directory(arguments.folder)) lock.emplace(arguments.folder);
          data = steps::run_report(arguments.folder, console);
        } else {
          data.title = "Program on measured tissue";
          data.is_of_a_study = false;
        }
        steps::add_on_tissue(arguments.registration, arguments.replay, data);
        steps::write_report_and_figures(data, output);
        print_result(options, {{"report", output.string()}});
        return kDone;
      });
  describe_output(*verb, "by default report.html in the run's folder, or here without one");
  verb->add_option("folder", a.folder, "A folder made by run, demo, simulate, …");
  verb->add_option("--registration", a.registration,
                   "A folder made by register: its figure and numbers go into the report");
  verb->add_option("--replay", a.replay, "A folder made by replay: its figure and numbers go into the report");
}

}  // namespace incise::cli
