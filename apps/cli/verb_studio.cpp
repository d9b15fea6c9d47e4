#include "option_checks.hpp"
#include "options.hpp"

#include <incise/studio/server.hpp>
#include <incise/studio/worker.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace incise::cli {
namespace {

struct StudioArguments {
  std::filesystem::path case_path;
  std::vector<std::filesystem::path> roots;
  unsigned short port = 0;
  std::filesystem::path worker;  ///< internal: this process computes for a studio
};

/// Returns the settings with the case file and, as first root, the folder in which the command was started, or the
/// folder of a case outside it.
studio::ServerSettings server_settings(const StudioArguments& arguments) {
  studio::ServerSettings settings;
  settings.port = arguments.port;
  settings.worker = {std::filesystem::read_symlink("/proc/self/exe").string(), "studio", "--worker"};
  settings.roots = {std::filesystem::current_path()};
  settings.roots.insert(settings.roots.end(), arguments.roots.begin(), arguments.roots.end());
  if (arguments.case_path.empty()) return settings;
  settings.case_file = std::filesystem::absolute(read_case_with_inputs(arguments.case_path).file);
  const std::filesystem::path folder = settings.case_file.parent_path();
  if (!is_same_or_within(folder, settings.roots.front())) settings.roots.push_back(folder);
  return settings;
}

int run_studio(const StudioArguments& arguments) {
  if (!arguments.worker.empty()) return studio::run_worker(arguments.worker);
  studio::serve(server_settings(arguments), [](const std::string& address) {
    std::printf("incise studio: open %s\nCtrl-C ends it. Results are kept in the case's folder.\n", address.c_str());
    std::fflush(stdout);
  });
  return kDone;
}

}  // namespace

void add_studio(Application& application) {
  auto [verb, a] = application.add_verb<StudioArguments>(
      "studio", "See the specimen, draw the tumour's edge, plan and watch the cut, in a browser on this machine",
      "incise studio my_patient",
      [](const StudioArguments& arguments, const CommonOptions&) { return run_studio(arguments); });
  describe_output(*verb, "not used: the studio writes into `out` in the case's folder");
  verb->add_option("case", a.case_path, "Case file, or a folder with case.yaml; none: choose in the browser");
  verb->add_option("--root", a.roots,
                   "Folder whose files may also be opened, besides the folder in which the studio is started");
  verb->add_option("--port", a.port, "Port of 127.0.0.1; 0: a free one")->check(whole_between("--port", 0, 65535));
  verb->add_option("--worker", a.worker)->group("");
}

}  // namespace incise::cli
