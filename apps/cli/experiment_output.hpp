#pragma once

#include <nlohmann/json.hpp>

namespace incise::cli {

// What a person wants of an experiment and of several; everything is in their files and reports.

/// @param result  study.json of an experiment.
void print_experiment(const nlohmann::ordered_json& result);

/// @param result  pooled.json.
void print_pooled(const nlohmann::ordered_json& result);

}  // namespace incise::cli
