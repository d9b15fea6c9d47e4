#pragma once

#include "options.hpp"

#include <incise/laboratory/bench_steps.hpp>

namespace incise::cli {

/// Prints the table of `incise power` for a person.
void print_power(const laboratory::PowerResult& result, const std::filesystem::path& folder);

/// Prints the speed of the timed cuts for a person.
void print_speed(const SpeedEstimate& speed);

}  // namespace incise::cli
