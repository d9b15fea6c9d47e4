#include "bench_options.hpp"
#include "bench_output.hpp"
#include "described_options.hpp"
#include "experiment_output.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/laboratory/acceptance.hpp>
#include <incise/laboratory/factor_screening.hpp>
#include <incise/laboratory/pooling.hpp>

#include <fmt/format.h>

namespace incise::cli {
namespace {

using BenchJson = nlohmann::ordered_json;

/// Prints everything with --json, else a table and a summary for a person.
int print_trials(const CommonOptions& options, const BenchJson& result, void (*print_table)(const BenchJson&),
                 const BenchJson& summary) {
  if (!options.json) print_table(result);
  print_result(options, options.json ? result : summary);
  return kDone;
}

int accept(const AcceptanceSettings& settings, const CommonOptions& options) {
  const BenchJson result =
      run_in_folder(options, "acceptance", [&](const auto& root, const auto& context, auto& workers, auto& console) {
        return accept_bench(settings, root, context, workers, console);
      });
  return print_trials(options, result, print_acceptance, result.at("summary"));
}

int screen(const ScreeningSettings& settings, const CommonOptions& options) {
  if (settings.factors.size() < 2)
    throw CaseError("command line", "--factors", fmt::format("{} of the factors", settings.factors.size()),
                    "at least two: with one, the effect of chance is not known");
  const BenchJson result =
      run_in_folder(options, "factors", [&](const auto& root, const auto& context, auto& workers, auto& console) {
        return screen_factors(settings, root, context, workers, console);
      });
  BenchJson summary{{"cuts", result.at("cuts")}, {"measured", result.at("measured")}};
  summary["left_out"] = result.at("left_out");
  if (!result.at("pairs").empty()) summary["least_p_of_pairs"] = result.at("pairs").front().at("p");
  summary["figure"] = result.at("figure");
  return print_trials(options, result, print_factors, summary);
}

int pool(const std::vector<std::filesystem::path>& experiments, const CommonOptions& options) {
  const std::filesystem::path output = options.required_output("pooled");
  refuse_input_as_output("-o", output, experiments);
  BenchJson result;
  {
    Console console(options.level());  // destroyed before the table is printed, to remove its bar
    result = pool_experiments(experiments, output, options.context(), console);
  }
  const BenchJson summary{{"pooled", (output / "pooled.json").string()}, {"figure", result.at("figure")}};
  return print_trials(options, result, print_pooled, summary);
}

}  // namespace

void add_bench_series(Application& application, CLI::App* bench) {
  auto [accepting, accepted] = application.add_verb<AcceptanceSettings>(
      "accept",
      "Cut specimens of laboratory 2 as planned and along the paper's correction, to judge the laboratory without the "
      "planner that it will judge. Run it again to continue where it stopped",
      "incise bench accept --seed 1 -o acceptance", accept, bench);
  add_options_of(*accepting, accepted, "specimens", "speed_mm_s", "power_w");
  add_factors(*accepting, kVaries,
              [&settings = accepted](second_bench::Factors factors) { settings.factors = std::move(factors); });
  add_overrides(*accepting, accepted.overrides);
  accepting->add_flag("!--no-paper-pass", accepted.with_paper_pass, "Cut only as planned");

  auto [screening, screened] = application.add_verb<ScreeningSettings>(
      "factors",
      "Find which factors of laboratory 2 drive the error as planned: a fractional factorial of up to 32 cuts of each "
      "specimen. Run it again to continue where it stopped",
      "incise bench factors --seed 1 -o factors", screen, bench);
  screening
      ->add_option("--specimens", screened.specimens, "Number of specimens, 1 to 24; their seeds count up from --seed")
      ->check(whole_between("--specimens", 1, 24));
  add_factors(*screening,
              "Factors of laboratory 2 to switch; the others stay off. By default all, with 32 cuts of each specimen; "
              "up to 8 factors need 16 cuts, 3 or 4 need 8, two need 4",
              [&settings = screened](second_bench::Factors factors) { settings.factors = std::move(factors); });
  add_overrides(*screening, screened.overrides);

  auto [pooling, pooled] = application.add_verb<std::vector<std::filesystem::path>>(
      "pool",
      "Pool several finished experiments: compare every path with the best one without simulation, and the advice with "
      "the outcome",
      "incise bench pool series1 series2 -o pooled", pool, bench);
  pooling->add_option("experiments", pooled, "Folders of `incise experiment`, two or more")
      ->required()
      ->expected(2, -1);
}

}  // namespace incise::cli
