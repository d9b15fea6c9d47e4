#pragma once

#include "options.hpp"

#include <incise/core/verdict.hpp>

#include <string>
#include <vector>

namespace incise::cli {

/// Adds --accept to a verb that writes a robot program.
void add_accept(CLI::App& verb, std::vector<std::string>& accepted);

/// Refuses (status 2) ids that are no cautions of verdict_rules(), naming the nearest one.
void require_accepted_ids(const std::vector<std::string>& accepted);

/// Prints the verdict for a person: its status, then a line for each reason, worst first.
void print_verdict(const nlohmann::ordered_json& verdict);

}  // namespace incise::cli
