#include "calibrated_case.hpp"

#include "option_checks.hpp"

namespace incise::cli {

CLI::Option* add_calibrated_options(CLI::App& verb, steps::CalibratedRequest& options) {
  verb.add_option("--stretch-force-n", options.stretch_force_n,
                  "Pull measured on this specimen when stretched; it determines the stiffness to 5 %. Without it, the "
                  "case's modulus is used, with much greater uncertainty")
      ->check(above_zero("--stretch-force-n"));
  return verb.add_option("--calibration", options.calibration, "calibration.json of `incise calibrate` (method fit)");
}

}  // namespace incise::cli
