#include "option_checks.hpp"
#include "options.hpp"
#include "paths_table.hpp"

#include <incise/core/error.hpp>
#include <incise/laboratory/acceptance.hpp>
#include <incise/laboratory/bench_steps.hpp>
#include <incise/laboratory/factor_screening.hpp>
#include <incise/laboratory/pooling.hpp>
#include <incise/robot/checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>

namespace incise::cli {
namespace {

void require_apart(const std::filesystem::path& truth, const std::filesystem::path& output) {
  if (truth.empty() || !(is_same_or_within(truth, output) || is_same_or_within(output, truth))) return;
  throw CaseError("command line", "--truth", truth.string(), "a folder apart from the output",
                  "The truth must not lie beside what a planner reads.");
}

int make(const CommonOptions& options, laboratory::MakeSpecimenRequest request) {
  request.output = options.required_output("specimen7");
  refuse_input_as_output("-o", request.output, {request.specimen});
  refuse_input_as_output("--truth", request.truth, {request.specimen});
  require_apart(request.truth, request.output);
  return run_step(options, [&](const auto& context) { return laboratory::make_specimen(request, context); });
}

int cut(const CommonOptions& options, laboratory::CutSpecimenRequest request) {
  request.output = options.required_output("cut7");
  refuse_input_as_output("-o", request.output, {request.specimen, request.program});
  refuse_input_as_output("--truth", request.truth, {request.specimen, request.program});
  require_apart(request.truth, request.output);
  return run_step(options, [&](const auto& context) { return laboratory::cut_specimen_by(request, context); });
}

int floor_of(const CommonOptions& options, laboratory::KnownPhysicsRequest request) {
  request.output = options.required_output("floor7.json");
  refuse_input_as_output("-o", request.output, {request.specimen});
  return run_step(options, [&](const auto& context) { return laboratory::cut_by_known_physics(request, context); });
}

/// Work that goes on in its folder where it was interrupted. @param work  (folder, context, workers, console) → JSON
template <class Work>
nlohmann::ordered_json run_in_folder(const CommonOptions& options, const char* example, Work work) {
  const std::filesystem::path root = options.required_output(example);
  std::filesystem::create_directories(root);
  try {
    Console console(options.level());
    Workers workers(options.threads);
    return work(root, options.context(), workers, console);
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("what was finished is kept in {}", root.string()));
  }
}

std::string two_decimals(const nlohmann::ordered_json& value) {
  return value.is_number() ? fmt::format("{:.2f}", value.get<double>()) : std::string("-");
}

int accept(const CommonOptions& options, const AcceptanceSettings& settings) {
  const nlohmann::ordered_json result =
      run_in_folder(options, "acceptance", [&](const auto& root, const auto& context, auto& workers, auto& console) {
        return accept_bench(settings, root, context, workers, console);
      });
  if (options.json) {
    print_result(options, result);
    return kDone;
  }
  fmt::print("VIRTUAL specimens, mean |error| of the photographs, mm\n{:>6} {:>10} {:>8} {:>12}\n", "seed", "planned",
             "paper's", "mm/s");
  for (const auto& row : result.at("rows")) {
    const auto& asked = row.at("prescription");
    fmt::print("{:>6} {:>10} {:>8} {:>12}\n", row.at("seed").get<std::uint64_t>(), two_decimals(row.at("planned_mm")),
               two_decimals(row.at("paper_pass_mm")), asked.is_object() ? two_decimals(asked.at("speed_mm_s")) : "-");
  }
  nlohmann::ordered_json summary = result.at("summary");
  print_result(options, summary);
  return kDone;
}

int screen(const CommonOptions& options, const ScreeningSettings& settings) {
  const nlohmann::ordered_json result =
      run_in_folder(options, "factors", [&](const auto& root, const auto& context, auto& workers, auto& console) {
        return screen_factors(settings, root, context, workers, console);
      });
  if (options.json) {
    print_result(options, result);
    return kDone;
  }
  const auto moved = [&](const char* name, const nlohmann::ordered_json& parts) {
    const auto part = [&](const char* key) {
      return parts.is_object() ? two_decimals(parts.at(key)) : std::string("-");
    };
    fmt::print("{:<14} {:>6} {:>6} {:>6}", name, part("level_mm"), part("shift_mm"), part("rest_mm"));
  };
  fmt::print(
      "VIRTUAL specimens: what a factor moves of each ring, and changes of the mean |error|, mm\n{:<14} {:>6} "
      "{:>6} {:>6} {:>24} {:>18}\n",
      "factor", "mean", "shift", "rest", "change (95 %)", "closed with/without");
  for (const auto& factor : result.at("factors")) {
    const auto& ends = factor.at("change_95_mm");
    moved(factor.at("factor").get<std::string>().c_str(), factor.at("moved"));
    fmt::print(
        " {:>24} {:>8}/{}\n",
        fmt::format("{} ({} to {})", two_decimals(factor.at("change_mm")),
                    two_decimals(ends.is_array() ? ends[0] : ends), two_decimals(ends.is_array() ? ends[1] : ends)),
        fmt::format("{} of {}", factor.at("measured_with").dump(), factor.at("made_with").dump()),
        fmt::format("{} of {}", factor.at("measured_without").dump(), factor.at("made_without").dump()));
  }
  moved("by chance", result.at("chance"));
  fmt::print("\n");
  nlohmann::ordered_json summary{{"cuts", result.at("cuts")}, {"measured", result.at("measured")}};
  summary["left_out"] = result.at("left_out");
  if (!result.at("pairs").empty()) summary["least_p_of_pairs"] = result.at("pairs").front().at("p");
  summary["figure"] = result.at("figure");
  print_result(options, summary);
  return kDone;
}

std::vector<std::string> factor_names() {
  std::vector<std::string> names(second_bench::kFactorNames.begin(), second_bench::kFactorNames.end());
  names.emplace_back("none");
  return names;
}

int pool(const CommonOptions& options, const std::vector<std::filesystem::path>& experiments) {
  const std::filesystem::path output = options.required_output("pooled");
  refuse_input_as_output("-o", output, experiments);
  Console console(options.level());
  const nlohmann::ordered_json result = pool_experiments(experiments, output, options.context(), console);
  if (options.json) {
    print_result(options, result);
    return kDone;
  }
  fmt::print("VIRTUAL specimens of {} series, mean |error| of the photographs\n", result.at("series").size());
  print_paths("path", result);
  print_paths("of these, unlike the calibration's", result.at("unlike"));
  print_paths("of these, like the calibration's", result.at("like"));
  const auto& robust = result.at("robust_against_default");
  if (robust.at("difference_mm").is_number()) {
    std::string interval;
    if (const auto& ends = robust.at("confidence_mm"); ends.is_array())
      interval = fmt::format(" ({:+.2f} to {:+.2f})", ends[0].get<double>(), ends[1].get<double>());
    fmt::print("{:<34} {:+.2f} mm{} on {} specimens; close margins of {}: {} by default, {} robust\n",
               "robust, difference from default", robust.at("difference_mm").get<double>(), interval,
               robust.at("compared").get<std::size_t>(), robust.at("closed").get<std::size_t>(),
               robust.at("close_margins_first").get<std::size_t>(),
               robust.at("close_margins_second").get<std::size_t>());
  }
  print_learning(result.at("learning"));
  if (result.at("advice").is_object())
    fmt::print("advice; its intervals treat specimens as independent, which those of a series are not\n");
  print_advice(result.at("advice"));
  nlohmann::ordered_json summary{{"pooled", (output / "pooled.json").string()}, {"figure", result.at("figure")}};
  print_result(options, summary);
  return kDone;
}

void add_factors(CLI::App& verb, const std::string& meaning, const std::function<void(second_bench::Factors)>& take) {
  verb.add_option_function<std::vector<std::string>>(
          "--factors",
          [take](const std::vector<std::string>& given) {
            if (given.size() > 1 && std::find(given.begin(), given.end(), "none") != given.end())
              throw CaseError("command line", "--factors", "none beside others", "none, or names of factors");
            second_bench::Factors factors;
            for (const std::string& name : given)
              if (name != "none") factors.insert(*value_of<second_bench::Factor>(name));
            take(std::move(factors));
          },
          meaning)
      ->delimiter(',')
      ->check(CLI::IsMember(factor_names()));
}

constexpr const char* kVaries =
    "Of laboratory 2: what varies beside placement, stretch and stiffness; the rest has the defaults of `incise schema "
    "bench2`. By default everything; none: nothing more";

void add_overrides(CLI::App& verb, std::vector<std::string>& overrides) {
  std::vector<std::string> checks;
  std::ranges::copy_if(check_names(), std::back_inserter(checks), can_be_overridden);
  verb.add_option("--override", overrides,
                  "Cut although this check of the program fails, as `incise export` would: the tissue is virtual. "
                  "Repeat for each check")
      ->expected(1)
      ->take_all()
      ->check(CLI::IsMember(checks));
}

}  // namespace

void add_bench(Application& application) {
  CLI::App* bench =
      application.add_group("bench", "The virtual laboratory: make a specimen's readings, cut it with a robot program",
                            "incise bench make --seed 7 -o specimen7 --truth hidden7");
  auto made = std::make_shared<laboratory::MakeSpecimenRequest>();
  CLI::App* verb = application.add_verb_to(
      *bench, "make", "Make the readings that a laboratory would have: CT, cloud, RGB-D frame, pull force",
      "incise bench make --bench 2 --seed 7 -o specimen7 --truth hidden7",
      [made](const CommonOptions& options) { return make(options, *made); });
  verb->add_option("specimen", made->specimen,
                   "Specimen file (incise schema bench, or bench2); without it one is drawn from the seed");
  verb->add_option("--bench", made->bench,
                   "1, or 2: the laboratory that varies far more. A specimen file says it itself")
      ->check(whole_between("--bench", 1, 2));
  add_factors(*verb, kVaries, [made](second_bench::Factors factors) { made->factors = std::move(factors); });
  verb->add_option("--series", made->series,
                   "Of laboratory 2: specimens of one series share the hand-eye error; by default the seed")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--truth", made->truth,
                   "Folder for the hidden truth; it holds the specimen.json that `bench cut` needs");
  verb->add_flag("--elasticity", made->has_elasticity, "Also a noisy elasticity map");

  auto run = std::make_shared<laboratory::CutSpecimenRequest>();
  verb = application.add_verb_to(*bench, "cut", "Cut a specimen with a robot program and photograph it",
                                 "incise bench cut hidden7/specimen.json cut.script -o cut7",
                                 [run](const CommonOptions& options) { return cut(options, *run); });
  verb->add_option("specimen", run->specimen, "The hidden specimen.json")->required();
  verb->add_option("program", run->program, "A program that `incise export` wrote: URScript, .csv or .json")
      ->required();
  verb->add_option("--power-w", run->power_w, "Power of the electrosurgical generator")->check(CLI::Range(1.0, 120.0));
  verb->add_option("--mm-per-pixel", run->mm_per_pixel, "Scale of the photograph")->check(CLI::Range(0.01, 0.2));
  verb->add_option("--truth", run->truth, "Folder for what really happened, for tests");

  auto floor = std::make_shared<laboratory::KnownPhysicsRequest>();
  verb = application.add_verb_to(
      *bench, "floor", "Find the error left to a planner that knows the bench's physics, but not the arm's errors",
      "incise bench floor hidden7/specimen.json -o floor7.json",
      [floor](const CommonOptions& options) { return floor_of(options, *floor); });
  verb->add_option("specimen", floor->specimen, "The hidden specimen.json")->required();
  verb->add_option("--power-w", floor->power_w, "Power of the electrosurgical generator")
      ->check(CLI::Range(1.0, 120.0));
  verb->add_option("--simulations", floor->simulations, "Bench cuts by which the path is corrected")
      ->check(whole_between("--simulations", 2, 8));

  auto accepted = std::make_shared<AcceptanceSettings>();
  verb = application.add_verb_to(
      *bench, "accept",
      "Cut specimens of laboratory 2 as planned and along the paper's correction, to judge the laboratory without the "
      "planner that it will judge. Run it again to continue where it stopped",
      "incise bench accept --seed 1 -o acceptance",
      [accepted](const CommonOptions& options) { return accept(options, *accepted); });
  verb->add_option("--specimens", accepted->specimens, "1 to 200; their seeds count up from --seed")
      ->check(whole_between("--specimens", 1, 200));
  add_factors(*verb, kVaries, [accepted](second_bench::Factors factors) { accepted->factors = std::move(factors); });
  verb->add_option("--speed-mm-s", accepted->speed_mm_s, "Of every cut; by default as prescribed")
      ->check(CLI::Range(1.0, 15.0));
  verb->add_option("--power-w", accepted->power_w, "Of every cut; by default as prescribed")
      ->check(CLI::Range(1.0, 120.0));
  add_overrides(*verb, accepted->overrides);
  verb->add_flag("!--no-paper-pass", accepted->with_paper_pass, "Cut as planned alone");

  auto screened = std::make_shared<ScreeningSettings>();
  verb =
      application.add_verb_to(*bench, "factors",
                              "Find which factors of laboratory 2 drive the error as planned: a fractional "
                              "factorial of up to 32 cuts of each specimen. Run it again to continue where it stopped",
                              "incise bench factors --seed 1 -o factors",
                              [screened](const CommonOptions& options) { return screen(options, *screened); });
  verb->add_option("--specimens", screened->specimens, "1 to 24; their seeds count up from --seed")
      ->check(whole_between("--specimens", 1, 24));
  add_factors(
      *verb,
      "Of laboratory 2: those to switch; the others stay off. By default all, by 32 cuts of each specimen; up to "
      "8 need 16, 3 or 4 need 8, two need 4",
      [screened](second_bench::Factors factors) {
        if (factors.size() < 2)
          throw CaseError("command line", "--factors", fmt::format("{} of them", factors.size()),
                          "at least two: with one, chance is not known");
        screened->factors = std::move(factors);
      });
  add_overrides(*verb, screened->overrides);

  auto pooled = std::make_shared<std::vector<std::filesystem::path>>();
  verb = application.add_verb_to(*bench, "pool",
                                 "Take several finished experiments together: every path against the best one without "
                                 "simulation, and the advice against what happened",
                                 "incise bench pool series1 series2 -o pooled",
                                 [pooled](const CommonOptions& options) { return pool(options, *pooled); });
  verb->add_option("experiments", *pooled, "Folders of `incise experiment`, two or more")->required()->expected(2, -1);
}

}  // namespace incise::cli
