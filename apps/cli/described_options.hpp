#pragma once

#include <incise/core/describe.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace incise::cli {

/// Returns the option of a field: "--residual-sd-mm" for residual_sd_mm.
[[nodiscard]] std::string option_name(std::string_view field);

/// Adds an option that sets a field of described settings. Its name, meaning, unit, range, choices and default come
/// from the description; a yes or no becomes a flag, which sets it. A value that the description does not allow is a
/// CaseError.
/// @param walk  visits the settings, which must live as long as the verb.
CLI::Option* add_option_of(CLI::App& verb, std::string_view field, const std::function<void(Visitor&)>& walk);

/// As add_option_of, for several fields. @param fields  of `settings` itself, not of a value inside it.
template <class T, class... Names>
void add_options_of(CLI::App& verb, T& settings, const Names&... fields) {
  const std::function<void(Visitor&)> walk = [&settings](Visitor& v) { describe(v, settings); };
  (add_option_of(verb, fields, walk), ...);
}

}  // namespace incise::cli
