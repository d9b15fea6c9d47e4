#pragma once

#include <incise/registration/register_clouds.hpp>

#include <nlohmann/json.hpp>

namespace incise {

/// What `registration.json` and `incise register --json` hold: T_target_source (4 x 4 row-major, scale included; null
/// where none was found), scale, rotation, translation_mm, rmse_mm, inlier_fraction, iterations, converged (true only
/// when nothing speaks against the transform), outcome, reasons, and under `certificate` how well it is determined.
/// Numbers that are not finite become null.
[[nodiscard]] nlohmann::ordered_json to_json(const Registration& registration);

}  // namespace incise
