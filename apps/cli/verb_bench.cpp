#include "bench_options.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/laboratory/bench_steps.hpp>

namespace incise::cli {
namespace {

void require_apart(const std::filesystem::path& truth, const std::filesystem::path& output) {
  if (truth.empty() || !(is_same_or_within(truth, output) || is_same_or_within(output, truth))) return;
  throw CaseError("command line", "--truth", truth.string(), "a folder apart from the output",
                  "The truth must not lie beside what a planner reads.");
}

int make(laboratory::MakeSpecimenRequest request, const CommonOptions& options) {
  request.output = options.required_output("specimen7");
  refuse_input_as_output("-o", request.output, {request.specimen});
  refuse_input_as_output("--truth", request.truth, {request.specimen});
  require_apart(request.truth, request.output);
  return run_step(options, [&](const auto& context) { return laboratory::make_specimen(request, context); });
}

int cut(laboratory::CutSpecimenRequest request, const CommonOptions& options) {
  request.output = options.required_output("cut7");
  refuse_input_as_output("-o", request.output, {request.specimen, request.program});
  refuse_input_as_output("--truth", request.truth, {request.specimen, request.program});
  require_apart(request.truth, request.output);
  return run_step(options, [&](const auto& context) { return laboratory::cut_specimen_by(request, context); });
}

int floor_of(laboratory::KnownPhysicsRequest request, const CommonOptions& options) {
  request.output = options.required_output("floor7.json");
  refuse_input_as_output("-o", request.output, {request.specimen});
  return run_step(options, [&](const auto& context) { return laboratory::cut_by_known_physics(request, context); });
}

}  // namespace

void add_bench(Application& application) {
  CLI::App* bench =
      application.add_group("bench", "The virtual laboratory: make a specimen's readings, cut it with a robot program",
                            "incise bench make --seed 7 -o specimen7 --truth hidden7");
  auto [making, made] = application.add_verb<laboratory::MakeSpecimenRequest>(
      "make", "Make the readings that a laboratory would have: CT, cloud, RGB-D frame, pull force",
      "incise bench make --bench 2 --seed 7 -o specimen7 --truth hidden7", make, bench);
  making->add_option("specimen", made.specimen,
                     "Specimen file (incise schema bench, or bench2); without it one is drawn from the seed");
  making
      ->add_option("--bench", made.bench, "Laboratory: 1, or 2, which varies far more. A specimen file states its own")
      ->check(whole_between("--bench", 1, 2));
  add_factors(*making, kVaries,
              [&request = made](second_bench::Factors factors) { request.factors = std::move(factors); });
  making
      ->add_option("--series", made.series,
                   "Series number in laboratory 2: specimens of one series share the hand-eye error; by default the "
                   "seed")
      ->check(CLI::NonNegativeNumber);
  making->add_option("--truth", made.truth,
                     "Folder for the hidden truth; it holds the specimen.json that `bench cut` needs");
  making->add_flag("--elasticity", made.has_elasticity, "Also make a noisy elasticity map");

  auto [cutting, run] = application.add_verb<laboratory::CutSpecimenRequest>(
      "cut", "Cut a specimen with a robot program and photograph it",
      "incise bench cut hidden7/specimen.json cut.script -o cut7", cut, bench);
  cutting->add_option("specimen", run.specimen, "The hidden specimen.json")->required();
  cutting->add_option("program", run.program, "A program that `incise export` wrote: URScript, .csv or .json")
      ->required();
  cutting->add_option("--power-w", run.power_w, "Power of the electrosurgical generator")
      ->check(CLI::Range(1.0, 120.0));
  cutting->add_option("--mm-per-pixel", run.mm_per_pixel, "Scale of the photograph")->check(CLI::Range(0.01, 0.2));
  cutting->add_option("--truth", run.truth, "Folder for the hidden truth of the cut, for tests");

  auto [finding, floor] = application.add_verb<laboratory::KnownPhysicsRequest>(
      "floor", "Find the error that remains if the planner knows the bench's physics, but not the arm's errors",
      "incise bench floor hidden7/specimen.json -o floor7.json", floor_of, bench);
  finding->add_option("specimen", floor.specimen, "The hidden specimen.json")->required();
  finding->add_option("--power-w", floor.power_w, "Power of the electrosurgical generator")
      ->check(CLI::Range(1.0, 120.0));
  finding->add_option("--simulations", floor.simulations, "Number of bench cuts used to correct the path")
      ->check(whole_between("--simulations", 2, 8));

  add_bench_series(application, bench);
}

}  // namespace incise::cli
