#include "option_checks.hpp"
#include "options.hpp"
#include "paths_table.hpp"

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

void print_gain(const char* name, const nlohmann::ordered_json& summary) {
  if (summary.at("pairs").get<std::size_t>() == 0) {
    fmt::print("{:<34} no specimen was cut twice\n", name);
    return;
  }
  const auto worse = summary.at("worse").get<std::size_t>();
  const auto opened = summary.at("opened").get<std::size_t>();
  std::string said = worse == 0 ? "none worse" : fmt::format("{} worse", worse);
  if (worse > opened) said += fmt::format(", by at most {:.2f} mm", summary.at("most_worse_mm").get<double>());
  if (opened > 0) said += fmt::format(", {} of them with an open ring", opened);
  fmt::print("{:<34} {:.2f} -> {:.2f} mm ({:.0f} % less); cut twice: {}, {}\n", name,
             summary.at("mean_before_mm").get<double>(), summary.at("mean_after_mm").get<double>(),
             summary.at("gain_percent").get<double>(), summary.at("pairs").get<std::size_t>(), said);
}

/// What a person wants of it; everything is in study.json and the report.
void print_summary(const nlohmann::ordered_json& result) {
  fmt::print("VIRTUAL specimens, mean |error| of the photographs\n");
  print_gain("as planned -> corrected", result);
  if (result.at("uncorrected").get<std::size_t>() > 0 && result.at("pairs").get<std::size_t>() > 0) {
    fmt::print("{:<34} {:.0f} % less; {} cut as planned alone\n", "  of all that were cut",
               result.at("gain_percent_of_all").get<double>(), result.at("uncorrected").get<std::size_t>());
  }
  print_paths("path", result);
  if (result.contains("unlike") && result.at("unlike").at("rivals").at("as_planned").at("pairs").get<std::size_t>() > 0)
    print_paths("of these, unlike the calibration's", result.at("unlike"));
  if (result.contains("known_physics") && result.at("known_physics").at("mean_after_mm").is_number()) {
    fmt::print("{:<34} {:.2f} mm ({} specimens, from the truth)\n", "physics known",
               result.at("known_physics").at("mean_after_mm").get<double>(),
               result.at("known_physics").at("specimens").get<std::size_t>());
  }
  print_learning(result.at("learning"));
  print_advice(result.at("advice"));
  for (const auto& one : result.at("left_out_of_calibration")) {
    fmt::print("{} (calibrate): left out of the fit: {}\n", one.at("name").get<std::string>(),
               one.at("reason").get<std::string>());
  }
  for (const auto& row : result.at("table_2")) {
    if (row.at("ended_at").is_null()) continue;
    fmt::print("{} ({}), {}: ended at {}\n", row.at("specimen").get<std::string>(), row.at("role").get<std::string>(),
               row.at("cut").get<std::string>(), row.at("ended_at").get<std::string>().substr(0, 100));
  }
  fmt::print("report: {}\n", result.at("report").get<std::string>());
}

/// Whether they name one folder, which may not be there yet, however they are spelt.
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
    throw CaseError("command line", "--truth", settings.truth.string() + ", the output", "a folder of its own");
  nlohmann::ordered_json result;
  try {
    Console console(options.level());  // its bar is gone before the summary
    Workers workers(options.threads);
    result = experiment(settings, root, options.context(), workers, console);
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("what was finished is kept in {}", root.string()));
  }
  options.json ? print_result(options, result) : print_summary(result);
  return result.at("pairs").get<std::size_t>() > 0 ? kDone : kNotAcceptable;
}

}  // namespace

void add_experiment(Application& application) {
  auto settings = std::make_shared<ExperimentSettings>();
  auto rule = std::make_shared<std::string>(to_string(CutRule::Tets));
  CLI::App* verb =
      application.add_verb("experiment",
                           "The paper's whole experiment on a virtual bench: specimens are cut as "
                           "planned, the simulation is calibrated to their photographs, further "
                           "specimens are cut as planned and corrected, and all is measured. Everything "
                           "in it is virtual. Run it again to continue where it stopped",
                           "incise experiment --quick -o experiment", [settings, rule](const CommonOptions& options) {
                             settings->rule = value_named<CutRule>(*rule);
                             return study(*settings, options);
                           });
  verb->alias("study");
  verb->add_option("--bench", settings->bench,
                   "1: the first laboratory, whose specimens are much alike; 2: the second, whose specimens, margins, "
                   "depths and speeds differ widely (`incise schema bench2`). Its specimens are one series, that of "
                   "--seed")
      ->check(whole_between("--bench", 1, 2));
  verb->add_option("--specimens", settings->specimens,
                   "2 to 200, even: half to calibrate on, half to test; 4: as in the paper, and one outside the "
                   "calibrated range. Their seeds count up from --seed, so start another experiment beyond the last "
                   "seed of this one")
      ->check(whole_between("--specimens", 2, 200));
  verb->add_flag("--quick", settings->is_quick, "Without the grid of 25 pairs of speed and dullness (Table I)");
  verb->add_option("--outside", settings->outside,
                   "Further specimens unlike those calibrated on (stiff, oedematous, scarred, oedematous, soft in "
                   "turn), to compare the advice of `assess` with what happens; "
                   "by default one with four specimens, else none. Of the first laboratory alone")
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
                              "numbers that ascend");
            settings->learning = photographs;
          },
          "Also cut test specimens along the forecasts of only the first so many photographs, such as 1,2,4,8, without "
          "and with simulation: what photographs are worth")
      ->delimiter(',')
      ->check(whole_between("--learning", 1, 100));
  verb->add_option("--tets", settings->tets, "Tetrahedra of the planner's meshes")
      ->check(whole_between("--tets", 5000, 500000));
  verb->add_option("--rule", *rule, "Of the planner's simulated cuts: cut.rule of its cases")
      ->check(name_of_any<CutRule>());
  verb->add_option("--truth", settings->truth, "Folder for the hidden specimens; by default truth/ in the output");
}

}  // namespace incise::cli
