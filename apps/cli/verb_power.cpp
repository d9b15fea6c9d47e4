#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"
#include "power_output.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/laboratory/case_steps.hpp>
#include <incise/storage/bench_files.hpp>
#include <incise/storage/power_file.hpp>

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <set>

namespace incise::cli {
namespace {

struct PowerArguments {
  std::vector<std::filesystem::path> files;
  std::optional<std::uint64_t> specimens;
  std::filesystem::path timed_cuts;
  std::optional<double> speed_mm_s;
  bool only_speed = false;
  PowerRequest request;
};

constexpr std::uint64_t kPapersTongues = 4;

std::vector<PowerSubject> subjects_of(const PowerArguments& arguments, std::uint64_t seed) {
  if (!arguments.files.empty() && arguments.specimens) {
    throw CaseError("command line", "--specimens", fmt::format("{} beside specimen files", *arguments.specimens),
                    "either files or a number of specimens to draw");
  }
  std::vector<PowerSubject> subjects;
  for (const std::filesystem::path& file : arguments.files) {
    const Specimen specimen = read_specimen(file);
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      if (!(subjects[i].specimen == specimen)) continue;
      throw CaseError("command line", "specimen", fmt::format("{}, the same as {}", file.string(), subjects[i].name),
                      "every specimen once");
    }
    subjects.push_back({file.string(), specimen});
  }
  if (!subjects.empty()) return subjects;
  for (std::uint64_t i = 0; i < arguments.specimens.value_or(kPapersTongues); ++i)
    subjects.push_back({fmt::format("seed {}", seed + i), draw_specimen(seed + i)});
  return subjects;
}

std::optional<SpeedEstimate> speed_of(const PowerArguments& arguments) {
  if (!arguments.timed_cuts.empty()) return estimate_speed(read_timed_cuts(arguments.timed_cuts));
  if (!arguments.only_speed) return std::nullopt;
  throw CaseError("command line", "--only-speed", "no timed cuts", "--timed-cuts FILE.csv");
}

/// Nothing is cut: the estimate goes to standard output alone.
int tell_speed(const SpeedEstimate& speed, const CommonOptions& options) {
  if (!options.json) {
    print_speed(speed);
    return kDone;
  }
  print_result(options, {{"verdict", "speed_only"}, {"chosen_w", nullptr}, {"speed_estimate", to_json(speed)}});
  return kDone;
}

void make_output(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw DataError(folder, "", error.message(), "a folder that can be made");
  laboratory::require_own_or_empty(folder, {"power.json", "cache"}, "a series");
  require_writable(folder / "power.json");
}

int find_power(PowerArguments arguments, const CommonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Console console(options.level());
  PowerResult result;
  result.speed = speed_of(arguments);
  if (arguments.only_speed) return tell_speed(*result.speed, options);
  result.request = arguments.request;
  if (arguments.speed_mm_s)
    result.request.speed_mm_s = *arguments.speed_mm_s;
  else if (result.speed)
    result.request.speed_mm_s = result.speed->recommended_mm_s;
  require_valid(validate(result.request));
  const std::filesystem::path output = options.required_output("power");
  result.subjects = subjects_of(arguments, options.seed);
  std::vector<std::filesystem::path> inputs = arguments.files;
  if (!arguments.timed_cuts.empty()) inputs.push_back(arguments.timed_cuts);
  for (const char* name : {"power.json", "power.csv"}) refuse_input_as_output("-o", output / name, inputs);
  OlderOutput older(output / "power.json", console);
  Workers workers(options.threads);
  laboratory::with_parts_kept(output, [&] {
    make_output(output);
    Cache cuts(std::make_unique<EntryFolder>(output / "cache"));
    result.series = run_power_series(result.subjects, result.request, cuts, workers, console);
    result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_power(output, result, inputs, options);
    older.replaced();
    print_power(options, result, output);
  });
  return result.series.choice.chosen_w ? kDone : kNotAcceptable;
}

void add_limits(CLI::App& verb, PowerRequest& request) {
  add_options_of(verb, request.limits, "bulge_limit_mm", "damage_limit_mm");
  verb.add_option("--fine-mm", request.resolution.fine_mm,
                  "Edge length of the tets round the cut; coarser ones are quicker, and change the results")
      ->check(between("--fine-mm", 0.8, request.resolution.coarse_mm));
}

}  // namespace

void add_power(Application& application) {
  auto arguments = std::make_shared<PowerArguments>();
  CLI::App* verb = application.add_verb(
      "power",
      "Find the lowest power that cuts virtual specimens without bulging and without thermal damage, as the paper did "
      "on four tongues; bulge against speed; a surgeon's speed from timed cuts. Virtual. If interrupted, it keeps "
      "every finished cut, and the same command continues",
      "incise power --specimens 4 --speeds-mm-s 3,5,7,9,11 -o power",
      [arguments](const CommonOptions& options) { return find_power(*arguments, options); });
  verb->add_option("specimen", arguments->files,
                   "Specimen files (incise schema bench); without them specimens are drawn from seeds");
  verb->add_option("--specimens", arguments->specimens, "How many to draw, from --seed on; 4 if not given")
      ->check(whole_between("--specimens", 1, 200));
  verb->add_option("--power-w", arguments->request.powers_w, "Powers of the generator, W")
      ->delimiter(',')
      ->check(between("--power-w", 1.0, 120.0));
  verb->add_option("--speed-mm-s", arguments->speed_mm_s,
                   "Speed of the series; by default that of the timed cuts, or 7 without them")
      ->check(between("--speed-mm-s", kSlowestCutMmS, kFastestCutMmS));
  verb->add_option("--speeds-mm-s,--speeds", arguments->request.speeds_mm_s,
                   "Also cut at these speeds, with the chosen power")
      ->delimiter(',')
      ->check(between("--speeds-mm-s", kSlowestCutMmS, kFastestCutMmS));
  verb->add_option("--timed-cuts", arguments->timed_cuts,
                   "Timed straight cuts of a surgeon: a CSV with the columns length_mm, time_s");
  verb->add_flag("--only-speed", arguments->only_speed, "Only report the speed of the timed cuts; cut nothing");
  add_limits(*verb, arguments->request);
}

}  // namespace incise::cli
