#include "calibrated_case.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

namespace incise::cli {
namespace {

struct CompensateOptions : CaseArguments {
  bool is_robust = false;
  bool is_unverified = false;
  steps::CalibratedRequest calibrated;
  double max_probability = ScenarioRequest{}.max_probability;
};

/// Requires that --robust and its options are given together.
void require_robust_options(const CompensateOptions& chosen) {
  const bool has_calibration = !chosen.calibrated.calibration.empty();
  if (chosen.is_robust && !has_calibration) {
    throw CaseError("command line", "--robust", "no --calibration",
                    "--calibration C.json, whose posterior the robust path must suit");
  }
  if (!chosen.is_robust && (has_calibration || chosen.calibrated.stretch_force_n)) {
    throw CaseError("command line", has_calibration ? "--calibration" : "--stretch-force-n", "no --robust",
                    "--robust: the other methods use no posterior");
  }
}

/// Computes a path from photographs of other cuts alone, without a simulated cut.
int shift_without_simulation(const CompensateOptions& chosen, const CommonOptions& options) {
  const steps::CaseRequest request = case_request(chosen, Stage::Compensate, options);
  const CompensationMethod method = request.file.settings.compensation.method;
  if (chosen.is_robust || method != CompensationMethod::Profile) {
    throw CaseError("command line", "--no-verify",
                    chosen.is_robust ? std::string("--robust") : fmt::format("method {}", to_string(method)),
                    "method profile: the others simulate the cuts that they correct");
  }
  for (const auto& [option, is_given] :
       {std::pair{"--resume", chosen.cut.must_resume}, std::pair{"--frames", chosen.cut.frames.has_value()}}) {
    if (is_given) throw CaseError("command line", option, "--no-verify", "only one of the two: no cut is simulated");
  }
  return run_step(options, [&](const auto& context) { return steps::run_stages(request, context); });
}

int compensate(const CompensateOptions& chosen, const CommonOptions& options) {
  require_robust_options(chosen);
  if (chosen.is_unverified) return shift_without_simulation(chosen, options);
  std::optional<steps::RobustRequest> robust;
  if (chosen.is_robust) robust = {steps::read_calibration_input(chosen.calibrated), chosen.max_probability};
  return run_step(
      options,
      [&](const auto& context) {
        return steps::compensate_case(case_request(chosen, Stage::Verify, options), robust, context);
      },
      print_study);
}

}  // namespace

void add_compensation_method(CLI::App& verb, CutOptions& options) {
  add_choice(verb, "--method", options.method,
             "default: pass by pass until the cut lies where it was intended, at most 4 cuts in all (8 if there is an "
             "objection to the best of them); paper: each waypoint moves once by the error simulated there; profile: "
             "each waypoint moves once by the case's compensation.photographed_mm. Overrides the case's "
             "compensation.method");
}

void add_compensate(Application& application) {
  auto [verb, a] =
      application.add_verb<CompensateOptions>("compensate", "", "incise compensate specimen -o out", compensate);
  add_case(*verb, a.case_path);
  add_cut_options(*verb, a.cut);
  add_compensation_method(*verb, a.cut);
  verb->add_flag("--no-verify", a.is_unverified,
                 "Method profile: move the path and stop, without any simulated cut. The path then has the caution "
                 "not_simulated, or the refusal that it gets before any cut");
  verb->add_flag(
      "--robust", a.is_robust,
      "Also choose the path of least expected error over the calibration's posterior, with a probability of a close "
      "margin anywhere of at most --max-probability: OUT/robust/path.json. Exit status 4 if there is none");
  add_calibrated_options(*verb, a.calibrated);
  verb->add_option("--max-probability", a.max_probability,
                   "Greatest allowed probability of less tissue than the close margin anywhere, with --robust")
      ->check(between("--max-probability", 1e-4, 0.9999));
}

}  // namespace incise::cli
