#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"
#include "power_output.hpp"

namespace incise::cli {
namespace {

int run_power(laboratory::PowerStepRequest request, const CommonOptions& options) {
  require_valid(validate(request.series));
  Console console(options.level());
  std::optional<OlderOutput> older;
  if (!request.only_speed) {
    request.output = options.required_output("power");
    std::vector<std::filesystem::path> inputs = request.files;
    if (!request.timed_cuts.empty()) inputs.push_back(request.timed_cuts);
    for (const char* name : {"power.json", "power.csv"}) refuse_input_as_output("-o", request.output / name, inputs);
    older.emplace(request.output / "power.json", console);
  }
  Workers workers(options.threads);
  const laboratory::PowerResult found =
      laboratory::find_power(request, {options.context(), workers, console, options.start});
  if (older) older->replaced();
  if (options.json) {
    print_result(options, found.step.json);
  } else {
    request.only_speed ? print_speed(*found.speed) : print_power(found, request.output);
  }
  return found.step.is_acceptable ? kDone : kNotAcceptable;
}

void add_limits(CLI::App& verb, PowerRequest& request) {
  add_options_of(verb, request.limits, "bulge_limit_mm", "damage_limit_mm");
  verb.add_option("--fine-mm", request.resolution.fine_mm,
                  "Edge length of the tets round the cut; coarser tets are faster, but change the results")
      ->check(between("--fine-mm", 0.8, request.resolution.coarse_mm));
}

}  // namespace

void add_power(Application& application) {
  auto [verb, a] = application.add_verb<laboratory::PowerStepRequest>(
      "power",
      "Find the lowest power that cuts virtual specimens without bulging and without thermal damage, as the paper did "
      "on four tongues. Also bulge against speed, and a surgeon's speed from timed cuts. Virtual. If interrupted, it "
      "keeps every finished cut, and the same command continues",
      "incise power --specimens 4 --speeds-mm-s 3,5,7,9,11 -o power", run_power);
  describe_output(*verb, "required, except with --only-speed");
  verb->add_option("specimen", a.files,
                   "Specimen files (incise schema bench); without them specimens are drawn from seeds");
  verb->add_option("--specimens", a.specimens, "Number of specimens to draw, with seeds from --seed on; 4 if not given")
      ->check(whole_between("--specimens", 1, 200));
  verb->add_option("--power-w", a.series.powers_w, "Powers of the generator, W")
      ->delimiter(',')
      ->check(between("--power-w", 1.0, 120.0));
  verb->add_option("--speed-mm-s", a.speed_mm_s,
                   "Speed of the series; by default that of the timed cuts, or 7 without them")
      ->check(between("--speed-mm-s", kSlowestCutMmS, kFastestCutMmS));
  verb->add_option("--speeds-mm-s,--speeds", a.series.speeds_mm_s, "Also cut at these speeds, with the chosen power")
      ->delimiter(',')
      ->check(between("--speeds-mm-s", kSlowestCutMmS, kFastestCutMmS));
  verb->add_option("--timed-cuts", a.timed_cuts,
                   "Timed straight cuts of a surgeon: a CSV with the columns length_mm, time_s");
  verb->add_flag("--only-speed", a.only_speed, "Only report the speed of the timed cuts; cut nothing");
  add_limits(*verb, a.series);
}

}  // namespace incise::cli
