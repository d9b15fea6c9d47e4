#pragma once

#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/types.hpp>

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace incise::cli {

/// Returns the finite number that is the whole text; a leading + is allowed.
[[nodiscard]] std::optional<double> number_in(const std::string& text);

/// Returns the whole number that is the whole text, in digits: not 2.5, 1e3, or 010, which the parser reads as octal.
template <typename Whole>
[[nodiscard]] std::optional<Whole> whole_number_in(const std::string& text) {
  Whole value = 0;
  const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_octal = text.size() > 1 && text.front() == '0';
  if (error != std::errc{} || at != text.data() + text.size() || is_octal) return std::nullopt;
  return value;
}

/// Refuses the value of an option; a text that is no number is quoted. @throws CaseError
[[noreturn]] void refuse_value(const std::string& option, const std::string& text, const std::string& expected);

/// Checks an option's number and throws a CaseError in the form of all other errors: option, found, expected. The
/// option's name is a parameter because a check does not receive it.
[[nodiscard]] CLI::Validator above_zero(const std::string& option);
/// From low to high, both allowed.
[[nodiscard]] CLI::Validator between(const std::string& option, double low, double high);

/// 0 is allowed.
[[nodiscard]] CLI::Validator zero_or_more(const std::string& option);
/// A whole number, see whole_number_in. From low to high, both allowed.
[[nodiscard]] CLI::Validator whole_between(const std::string& option, std::uint64_t low, std::uint64_t high);

/// One of the names of an enum.
template <Named E>
[[nodiscard]] CLI::Validator name_of_any() {
  const Names names = names_of(E{});
  return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}
/// Returns the value of such a name. @pre the name has been checked
template <Named E>
[[nodiscard]] E value_named(const std::string& name) {
  return value_of<E>(name).value();
}

/// Adds an option that sets an enum by one of its names; without it, it stays absent.
/// @param value  must live as long as the verb.
template <Named E>
CLI::Option* add_choice(CLI::App& verb, const std::string& option, std::optional<E>& value,
                        const std::string& meaning) {
  const auto set = [&value](const std::string& name) { value = value_named<E>(name); };
  return verb.add_option_function<std::string>(option, set, meaning)->check(name_of_any<E>());
}
/// As above, of an enum whose present value is the default.
template <Named E>
CLI::Option* add_choice(CLI::App& verb, const std::string& option, E& value, const std::string& meaning) {
  const auto set = [&value](const std::string& name) { value = value_named<E>(name); };
  return verb.add_option_function<std::string>(option, set, meaning)
      ->check(name_of_any<E>())
      ->default_str(std::string(to_string(value)));
}

/// @throws CaseError for the first violation ("close_margin_mm: found -1, expected …"), named after its option
/// (--close-margin-mm). Does nothing without violations.
void require_valid(const std::vector<Problem>& violations);

/// Returns three numbers of an option as a direction. @throws CaseError for a direction of length 0.
[[nodiscard]] Vec3 direction_of(const std::vector<double>& numbers, const char* option);

}  // namespace incise::cli
