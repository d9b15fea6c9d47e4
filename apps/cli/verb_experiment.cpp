#include "bench_options.hpp"
#include "experiment_output.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/laboratory/experiment.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

namespace incise::cli {
namespace {

/// Whether two names, however they are spelt, are of one folder, which need not exist.
bool is_same_folder(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto plain = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path) / "").lexically_normal() / "";
  };
  return plain(a) == plain(b);
}

int study(const ExperimentSettings& settings, const CommonOptions& options) {
  if (settings.specimens % 2 != 0)
    throw CaseError("command line", "--specimens", fmt::format("{}", settings.specimens),
                    "an even number: half to calibrate on, half to test");
  const std::filesystem::path root = options.required_output("experiment");
  if (!settings.truth.empty() && is_same_folder(settings.truth, root))
    throw CaseError("command line", "--truth", settings.truth.string() + ", which is the output", "a separate folder");
  const nlohmann::ordered_json result =
      run_in_folder(options, "experiment", [&](const auto& folder, const auto& context, auto& workers, auto& console) {
        return experiment(settings, folder, context, workers, console);
      });
  options.json ? print_result(options, result) : print_experiment(result);
  return result.at("pairs").get<std::size_t>() > 0 ? kDone : kNotAcceptable;
}

}  // namespace

void add_experiment(Application& application) {
  auto settings = std::make_shared<ExperimentSettings>();
  auto rule = std::make_shared<std::string>(to_string(CutRule::Tets));
  CLI::App* verb =
      application.add_verb("experiment",
                           "The paper's whole experiment on a virtual bench: cut specimens as planned, calibrate the "
                           "simulation to their photographs, cut further specimens as planned and corrected, and "
                           "measure all cuts. Everything is virtual. Run it again to continue where it stopped",
                           "incise experiment --quick -o experiment", [settings, rule](const CommonOptions& options) {
                             settings->rule = value_named<CutRule>(*rule);
                             return study(*settings, options);
                           });
  verb->alias("study");
  verb->add_option("--bench", settings->bench,
                   "1: the first laboratory, whose specimens are much alike; 2: the second, whose specimens, margins, "
                   "depths and speeds differ widely (`incise schema bench2`). Specimens of laboratory 2 are one "
                   "series, that of --seed")
      ->check(whole_between("--bench", 1, 2));
  verb->add_option("--specimens", settings->specimens,
                   "Number of specimens, 2 to 200, even: half to calibrate on, half to test; 4: as in the paper, and "
                   "one outside the calibrated range. Their seeds count up from --seed, so start another experiment "
                   "beyond the last seed of this one")
      ->check(whole_between("--specimens", 2, 200));
  verb->add_flag("--quick", settings->is_quick, "Skip the grid of 25 pairs of speed and dullness (Table I)");
  verb->add_option("--outside", settings->outside,
                   "Further specimens unlike those calibrated on (stiff, oedematous, scarred, oedematous, soft in "
                   "turn), to compare the advice of `assess` with what happens; by default one if there are four "
                   "specimens, otherwise none. First laboratory only")
      ->check(whole_between("--outside", 0, 200));
  verb->add_flag("!--no-rivals", settings->with_rivals,
                 "Do not cut test specimens along the rivals' paths (constant offset, mean profiles and "
                 "forecast of the photographs, the paper's pass, incise without calibration, and photographs with "
                 "simulation). Faster, but then no benefit of "
                 "simulation can be claimed");
  verb->add_flag("--paper-pass", settings->with_paper_pass,
                 "With --no-rivals: still cut along the paper's single radial correction");
  verb->add_flag("--known-physics", settings->with_known_physics,
                 "Also cut every test specimen as a planner that knows the bench's physics would (first laboratory)");
  verb->add_flag("--withheld-force", settings->with_withheld_force,
                 "Also run `assess` as if the pull had not been measured");
  verb->add_option_function<std::vector<std::size_t>>(
          "--learning",
          [settings](const std::vector<std::size_t>& photographs) {
            if (std::adjacent_find(photographs.begin(), photographs.end(), std::greater_equal<>()) != photographs.end())
              throw CaseError("command line", "--learning", fmt::format("{}", fmt::join(photographs, ",")),
                              "ascending numbers");
            settings->learning = photographs;
          },
          "Also cut test specimens along forecasts from only the first photographs, as many as each of these numbers "
          "(such as 1,2,4,8), without and with simulation, to show what photographs are worth")
      ->delimiter(',')
      ->check(whole_between("--learning", 1, 100));
  add_overrides(*verb, settings->overrides);
  verb->add_option("--tets", settings->tets, "Number of tetrahedra of the planner's meshes")
      ->check(whole_between("--tets", 5000, 500000));
  verb->add_option("--rule", *rule, "Rule of the planner's simulated cuts: cut.rule of its cases")
      ->check(name_of_any<CutRule>());
  verb->add_option("--truth", settings->truth, "Folder for the hidden specimens; by default truth/ in the output");
}

}  // namespace incise::cli
