#include "bench_options.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/laboratory/bench_steps.hpp>

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
  verb->add_option("--bench", made->bench, "Laboratory: 1, or 2, which varies far more. A specimen file states its own")
      ->check(whole_between("--bench", 1, 2));
  add_factors(*verb, kVaries, [made](second_bench::Factors factors) { made->factors = std::move(factors); });
  verb->add_option("--series", made->series,
                   "Series number in laboratory 2: specimens of one series share the hand-eye error; by default the "
                   "seed")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--truth", made->truth,
                   "Folder for the hidden truth; it holds the specimen.json that `bench cut` needs");
  verb->add_flag("--elasticity", made->has_elasticity, "Also make a noisy elasticity map");

  auto run = std::make_shared<laboratory::CutSpecimenRequest>();
  verb = application.add_verb_to(*bench, "cut", "Cut a specimen with a robot program and photograph it",
                                 "incise bench cut hidden7/specimen.json cut.script -o cut7",
                                 [run](const CommonOptions& options) { return cut(options, *run); });
  verb->add_option("specimen", run->specimen, "The hidden specimen.json")->required();
  verb->add_option("program", run->program, "A program that `incise export` wrote: URScript, .csv or .json")
      ->required();
  verb->add_option("--power-w", run->power_w, "Power of the electrosurgical generator")->check(CLI::Range(1.0, 120.0));
  verb->add_option("--mm-per-pixel", run->mm_per_pixel, "Scale of the photograph")->check(CLI::Range(0.01, 0.2));
  verb->add_option("--truth", run->truth, "Folder for the hidden truth of the cut, for tests");

  auto floor = std::make_shared<laboratory::KnownPhysicsRequest>();
  verb = application.add_verb_to(
      *bench, "floor", "Find the error that remains if the planner knows the bench's physics, but not the arm's errors",
      "incise bench floor hidden7/specimen.json -o floor7.json",
      [floor](const CommonOptions& options) { return floor_of(options, *floor); });
  verb->add_option("specimen", floor->specimen, "The hidden specimen.json")->required();
  verb->add_option("--power-w", floor->power_w, "Power of the electrosurgical generator")
      ->check(CLI::Range(1.0, 120.0));
  verb->add_option("--simulations", floor->simulations, "Number of bench cuts used to correct the path")
      ->check(whole_between("--simulations", 2, 8));

  add_bench_series(application, *bench);
}

}  // namespace incise::cli
