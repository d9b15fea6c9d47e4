#include "phantom_case.hpp"
#include "study_run.hpp"
#include "verdict_gate.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_text.hpp>

#include <fmt/format.h>

#include <memory>

namespace incise::cli {
namespace {

constexpr const char* kFormat = "dicom";

/// The virtual specimen of this seed, made unless a complete one is there.
std::filesystem::path specimen_for(const std::filesystem::path& folder, std::uint64_t seed, Monitor& monitor) {
  const std::filesystem::path truth = folder / "truth.json";
  if (!std::filesystem::exists(truth)) {
    write_phantom_case(folder, seed, kFormat, monitor);
  } else if (const auto found = read_json(truth).value("seed", std::uint64_t{0}); found != seed) {
    throw CaseError("command line", "--seed", fmt::format("{}", seed), fmt::format("{}, the specimen that is in {}", found, folder.string()),
                    "Choose another folder with -o for another specimen");
  }
  return folder;
}

}  // namespace

void add_demo(Application& application) {
  auto cut = std::make_shared<CutOptions>();
  CLI::App* verb = application.add_verb("demo", "", "incise demo -o demo", [cut](const CommonOptions& options) {
    Console console(options.level());
    require_accepted_ids(cut->accepted);
    const std::filesystem::path root = options.output.empty() ? std::filesystem::path("demo") : options.output;
    const std::filesystem::path specimen = specimen_for(root / "specimen", options.seed, console);
    try {
      return run_whole_loop(specimen, root, options, *cut, console);
    } catch (const StagesKept&) {
      throw;
    } catch (const Cancelled& error) {
      throw StagesKept(error.what(), fmt::format("the specimen in {} is kept", specimen.string()));
    }
  });
  add_cut_options(*verb, *cut);
  add_compensation_method(*verb, *cut);
  add_accept(*verb, cut->accepted);
}

}  // namespace incise::cli
