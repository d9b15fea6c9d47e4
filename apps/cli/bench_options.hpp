#pragma once

#include "options.hpp"

#include <incise/laboratory/acceptance.hpp>

namespace incise::cli {

/// Meaning of `--factors` for verbs that draw their specimens, unless a verb says otherwise.
inline constexpr const char* kVaries =
    "Factors of laboratory 2 that vary, besides placement, stretch and stiffness; all others keep the defaults of "
    "`incise schema bench2`. By default all vary; none: no other factor varies";

/// Adds `--factors`: none, or names of factors of laboratory 2.
void add_factors(CLI::App& verb, const std::string& meaning, const std::function<void(second_bench::Factors)>& take);

/// Adds `--override`: checks of the program that may fail.
void add_overrides(CLI::App& verb, std::vector<std::string>& overrides);

/// Runs work that continues in its folder where it was interrupted. If it is interrupted again, the error says so.
/// @param work  called with folder, context, workers and console.
[[nodiscard]] nlohmann::ordered_json run_in_folder(
    const CommonOptions& options, const char* example,
    const std::function<nlohmann::ordered_json(const std::filesystem::path&, const RunContext&, Workers&, Console&)>&
        work);

}  // namespace incise::cli
