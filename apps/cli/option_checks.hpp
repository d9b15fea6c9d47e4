#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace incise::cli {

/// A check of an option's number in the words of all other errors: option, found, expected. The option's name is given
/// because a check does not learn it. It throws CaseError.
[[nodiscard]] CLI::Validator above_zero(const std::string& option);
/// From low to high, both allowed.
[[nodiscard]] CLI::Validator between(const std::string& option, double low, double high);

/// @throws CaseError for the first violation ("close_margin_mm: found -1, expected …"), as one about the option of that
/// name (--close-margin-mm); nothing for none.
void require_valid(const std::vector<std::string>& violations);

}  // namespace incise::cli
