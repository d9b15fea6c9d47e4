#pragma once

#include <nlohmann/json.hpp>

namespace incise::cli {

/// Every path of an experiment, or of several, and how it compares with the best one without a simulated cut.
/// @param of  heading of the first column. @param result  `rivals` and `best_without_simulation`.
void print_paths(const char* of, const nlohmann::ordered_json& result);

/// What photographs are worth, without and with simulation. @param curve  empty: nothing.
void print_learning(const nlohmann::ordered_json& curve);

/// How the advice held against what happened. @param advice  that of an experiment, or of several; null: nothing.
void print_advice(const nlohmann::ordered_json& advice);

}  // namespace incise::cli
