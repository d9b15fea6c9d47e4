#pragma once

#include <nlohmann/json.hpp>

namespace incise::cli {

/// Prints the specimens of an acceptance, as planned and along the paper's pass. @param result  of accept_bench.
void print_acceptance(const nlohmann::ordered_json& result);

/// Prints the effect of each factor. @param result  of screen_factors.
void print_factors(const nlohmann::ordered_json& result);

}  // namespace incise::cli
