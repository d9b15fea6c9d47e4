#pragma once

#include "study_run.hpp"

#include <incise/steps/case_steps.hpp>

namespace incise::cli {

/// Adds --calibration and --stretch-force-n to a verb that plans by a calibration. @returns the first.
CLI::Option* add_calibrated_options(CLI::App& verb, steps::CalibratedRequest& options);

}  // namespace incise::cli
