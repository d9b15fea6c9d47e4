#pragma once

#include <nlohmann/json.hpp>

namespace incise::cli {

// Summaries of one and of several experiments for a person. Their files and reports contain everything.

/// @param result  study.json of an experiment.
void print_experiment(const nlohmann::ordered_json& result);

/// @param result  pooled.json.
void print_pooled(const nlohmann::ordered_json& result);

}  // namespace incise::cli
