#pragma once

#include "options.hpp"

#include <incise/laboratory/acceptance.hpp>

namespace incise::cli {

/// Of a verb whose specimens are drawn: what `--factors` says where nothing else is meant.
inline constexpr const char* kVaries =
    "Of laboratory 2: what varies beside placement, stretch and stiffness; the rest has the defaults of `incise schema "
    "bench2`. By default everything; none: nothing more";

/// `--factors`: none, or names of factors of laboratory 2.
void add_factors(CLI::App& verb, const std::string& meaning, const std::function<void(second_bench::Factors)>& take);

/// `--override`: checks of the program that may fail.
void add_overrides(CLI::App& verb, std::vector<std::string>& overrides);

/// Work that goes on in its folder where it was interrupted; says so where it is interrupted again.
/// @param work  of (folder, context, workers, console).
[[nodiscard]] nlohmann::ordered_json run_in_folder(
    const CommonOptions& options, const char* example,
    const std::function<nlohmann::ordered_json(const std::filesystem::path&, const RunContext&, Workers&, Console&)>&
        work);

}  // namespace incise::cli
