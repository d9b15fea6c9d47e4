#include "bench_options.hpp"
#include "described_options.hpp"
#include "experiment_output.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/laboratory/experiment.hpp>

#include <string>

namespace incise::cli {
namespace {

int study(const ExperimentSettings& settings, const CommonOptions& options) {
  require_valid(validate(settings));
  const std::filesystem::path root = options.required_output("experiment");
  const std::filesystem::path& truth = settings.truth;
  if (!truth.empty() && is_same_or_within(truth, root) && is_same_or_within(root, truth))
    throw CaseError("command line", "--truth", truth.string() + ", which is the output", "a separate folder");
  const nlohmann::ordered_json result =
      run_in_folder(options, "experiment", [&](const auto& folder, const auto& context, auto& workers, auto& console) {
        return experiment(settings, folder, context, workers, console);
      });
  options.json ? print_result(options, result) : print_experiment(result);
  return result.at("pairs").get<std::size_t>() > 0 ? kDone : kNotAcceptable;
}

}  // namespace

void add_experiment(Application& application) {
  auto [verb, settings] = application.add_verb<ExperimentSettings>(
      "experiment",
      "The paper's whole experiment on a virtual bench: cut specimens as planned, calibrate the simulation to their "
      "photographs, cut further specimens as planned and corrected, and measure all cuts. Everything is virtual. Run "
      "it again to continue where it stopped",
      "incise experiment --quick -o experiment", study);
  verb->alias("study");
  add_options_of(*verb, settings, "bench", "specimens", "quick", "outside");
  verb->add_flag("!--no-rivals", settings.with_rivals,
                 "Do not cut test specimens along the rivals' paths (constant offset, mean profiles and "
                 "forecast of the photographs, the paper's pass, incise without calibration, and photographs with "
                 "simulation). Faster, but then no benefit of simulation can be claimed");
  add_options_of(*verb, settings, "paper_pass", "known_physics", "withheld_force", "learning");
  verb->get_option("--learning")->delimiter(',');
  add_overrides(*verb, settings.overrides);
  add_options_of(*verb, settings, "tets", "rule", "truth");
}

}  // namespace incise::cli
