#pragma once

#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/types.hpp>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace incise::cli {

/// A finite number, all of the text; a leading + is allowed.
[[nodiscard]] std::optional<double> number_in(const std::string& text);

/// A check of an option's number in the words of all other errors: option, found, expected. The option's name is given
/// because a check does not learn it. It throws CaseError.
[[nodiscard]] CLI::Validator above_zero(const std::string& option);
/// From low to high, both allowed.
[[nodiscard]] CLI::Validator between(const std::string& option, double low, double high);

/// 0 is allowed.
[[nodiscard]] CLI::Validator zero_or_more(const std::string& option);
/// Any that is finite.
[[nodiscard]] CLI::Validator finite(const std::string& option);
/// Digits alone: neither 2.5 nor 1e3 nor 010. From low to high, both allowed.
[[nodiscard]] CLI::Validator whole_between(const std::string& option, std::uint64_t low, std::uint64_t high);

/// One of an enum's names.
template <Named E>
[[nodiscard]] CLI::Validator name_of_any() {
  const Names names = names_of(E{});
  return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}
/// The value that such a name stands for. @pre the name has been checked
template <Named E>
[[nodiscard]] E value_named(const std::string& name) {
  return value_of<E>(name).value();
}

/// @throws CaseError for the first violation ("close_margin_mm: found -1, expected …"), as one about the option of that
/// name (--close-margin-mm); nothing for none.
void require_valid(const std::vector<Problem>& violations);

/// Three numbers of an option as a direction. @throws CaseError for one of length 0.
[[nodiscard]] Vec3 direction_of(const std::vector<double>& numbers, const char* option);

}  // namespace incise::cli
