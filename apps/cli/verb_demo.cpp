#include "study_run.hpp"
#include "verdict_gate.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/bench_steps.hpp>
#include <incise/storage/own_files.hpp>

#include <fmt/format.h>

namespace incise::cli {
namespace {

/// Refuses a folder with a run of a case other than the demo's own: its results would be replaced.
void require_own_run(const std::filesystem::path& root) {
  require_own_files(root);
  const std::filesystem::path record = root / "study.json";
  if (!std::filesystem::exists(record)) return;
  const nlohmann::ordered_json found = read_json(record).at("case_file");
  if (found != "specimen/case.yaml")
    throw DataError(record, "case_file", found.dump(), "\"specimen/case.yaml\", the demo's own case",
                    "Choose another place for the output");
}

/// Returns the virtual specimen of this seed, making it unless a complete one exists.
std::filesystem::path specimen_for(const std::filesystem::path& folder, const CommonOptions& options) {
  const std::filesystem::path truth = folder / "truth.json";
  if (!std::filesystem::exists(truth)) {
    Console console(options.level());
    Workers one(1);
    laboratory::make_phantom_case({.output = folder}, {options.context(), one, console});
  } else if (const auto found = read_json(truth).value("seed", std::uint64_t{0}); found != options.seed) {
    throw CaseError("command line", "--seed", fmt::format("{}", options.seed),
                    fmt::format("{}, the seed of the specimen in {}", found, folder.string()),
                    "Choose another folder with -o for another specimen");
  }
  return folder;
}

int demo(const CutOptions& cut, const CommonOptions& options) {
  require_accepted_ids(cut.accepted);
  const std::filesystem::path root = options.output.empty() ? std::filesystem::path("demo") : options.output;
  require_own_run(root);
  const std::filesystem::path specimen = specimen_for(root / "specimen", options);
  try {
    return run_whole_loop({specimen, cut}, root, options);
  } catch (const StagesKept&) {
    throw;
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("the specimen in {} is kept", specimen.string()));
  }
}

}  // namespace

void add_demo(Application& application) {
  auto [verb, cut] = application.add_verb<CutOptions>("demo", "", "incise demo -o demo", demo);
  describe_output(*verb, "by default `demo`");
  add_cut_options(*verb, cut);
  add_compensation_method(*verb, cut);
  add_accept(*verb, cut.accepted);
}

}  // namespace incise::cli
