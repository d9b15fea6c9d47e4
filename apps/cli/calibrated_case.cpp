#include "calibrated_case.hpp"

#include "option_checks.hpp"

#include <incise/core/error.hpp>

namespace incise::cli {

CLI::Option* add_calibrated_options(CLI::App& verb, CalibratedOptions& options) {
  verb.add_option("--stretch-force-n", options.stretch_force_n,
                  "Measured pull of this specimen at its stretch: makes its stiffness known to 5 %. Without it the "
                  "case's modulus is believed, and much less surely")
      ->check(above_zero("--stretch-force-n"));
  return verb.add_option("--calibration", options.calibration, "calibration.json of `incise calibrate` (method fit)");
}

CalibrationInput read_calibration_input(const CalibratedOptions& options) {
  Calibration found = read_calibration(options.calibration);
  CalibratedBelief belief = belief_of(found, options.calibration);
  if (options.stretch_force_n && !belief.knows_forces) {
    throw CaseError("command line", "--stretch-force-n", "a pull, and a calibration that was made without",
                    "both with the pull of the suture, or both without");
  }
  return {options.calibration, std::move(found), std::move(belief)};
}

ScenarioRequest scenario_request(const CalibratedOptions& chosen, const CommonOptions& options) {
  ScenarioRequest request;
  request.stretch_force_n = chosen.stretch_force_n;
  request.seed = options.seed;
  return request;
}

}  // namespace incise::cli
