#include "calibration_output.hpp"
#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::cli {
namespace {

/// Requires one entry per case, or none if that is allowed.
void require_one_each(const char* option, std::size_t found, std::size_t cases, const char* what) {
  if (found == cases) return;
  throw CaseError("command line", option, fmt::format("{} for {} {}", found, cases, cases == 1 ? "case" : "cases"),
                  fmt::format("one {} for each case, in the same order", what));
}

/// Refuses a repeated value, which would repeat a row of the grid.
void require_different_values(const char* option, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto twice = std::adjacent_find(values.begin(), values.end());
  if (twice != values.end())
    throw CaseError("command line", option, fmt::format("{} twice", *twice), "each value once");
}

int calibrate_cases(steps::CalibrateRequest request, const CommonOptions& options) {
  const CalibrationRequest& asked = request.request;
  require_valid(validate(asked));
  require_different_values("--speeds-mm-s", asked.speeds_mm_s);
  require_different_values("--dullnesses", asked.dullnesses);
  require_different_values("--drag-lengths-mm", asked.drag_lengths_mm);
  require_different_values("--second-drag-lengths-mm", asked.second_drag_lengths_mm);
  request.output = options.required_output("calibration");
  const std::size_t cases = request.cases.size();
  require_one_each("--observed", request.observed.size(), cases, "evaluation");
  if (!request.forces_n.empty()) require_one_each("--stretch-force-n", request.forces_n.size(), cases, "force");
  if (!request.registrations.empty())
    require_one_each("--registration", request.registrations.size(), cases, "registration");
  Console console(options.level());
  Workers workers(options.threads);
  OlderOutput older(request.output / "calibration.json", console);
  const steps::CalibrateResult done =
      steps::calibrate_on_cuts(request, {options.context(), workers, console, options.start});
  older.replaced();
  options.json ? print_result(options, done.step.json) : print_calibration(done.calibration, request.output);
  return done.step.is_acceptable ? kDone : kNotAcceptable;
}

}  // namespace

void add_calibrate(Application& application) {
  auto [verb, a] = application.add_verb<steps::CalibrateRequest>(
      "calibrate",
      "Find the simulated speed and dullness that reproduce photographed cuts. fit: from the signed error round the "
      "ring, with few simulations; gives a posterior, and states which parameters the data identify. paper: 25 pairs, "
      "scored as in the paper. If interrupted, it keeps every finished simulation, and the same command continues",
      "incise calibrate s1 s2 --observed s1/cut.json s2/cut.json -o calibration", calibrate_cases);
  verb->add_option("case", a.cases, "Case files, or folders with case.yaml: how each specimen was held, and its path")
      ->required();
  verb->add_option("--observed", a.observed,
                   "Files of `incise evaluate PHOTO -o`, one for each case in the same order; up in the picture is "
                   "+y of the case (seen along -z)")
      ->required();
  verb->add_option("--stretch-force-n", a.forces_n,
                   "Pull measured on each specimen when stretched; it determines the stiffness to 5 %")
      ->check(above_zero("--stretch-force-n"));
  verb->add_option("--registration", a.registrations,
                   "Files of `incise register`, one for each case; the calibration keeps them, and `incise assess` "
                   "compares further specimens with them");
  add_options_of(*verb, a.request, "method", "speeds_mm_s", "dullnesses", "drag_lengths_mm", "second_drag_lengths_mm");
}

}  // namespace incise::cli
