#include "option_checks.hpp"

#include "described_options.hpp"

#include <incise/core/direction.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

namespace incise::cli {

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || at != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

void refuse_value(const std::string& option, const std::string& text, const std::string& expected) {
  throw CaseError("command line", option, number_in(text) ? text : "'" + text + "'", expected);
}

namespace {

template <typename IsAllowed>
CLI::Validator check_of(const std::string& option, const std::string& expected, const IsAllowed& is_allowed) {
  return CLI::Validator(
      [option, expected, is_allowed](std::string& text) {
        const std::optional<double> value = number_in(text);
        if (!value || !is_allowed(*value)) refuse_value(option, text, expected);
        return std::string();
      },
      "");
}

}  // namespace

CLI::Validator above_zero(const std::string& option) {
  return check_of(option, "a number above 0", [](double value) { return value > 0.0; });
}

CLI::Validator between(const std::string& option, double low, double high) {
  return check_of(option, fmt::format("a number from {} to {}", low, high),
                  [low, high](double value) { return value >= low && value <= high; });
}

CLI::Validator zero_or_more(const std::string& option) {
  return check_of(option, "a number of at least 0", [](double value) { return value >= 0.0; });
}

CLI::Validator whole_between(const std::string& option, std::uint64_t low, std::uint64_t high) {
  return CLI::Validator(
      [option, low, high](std::string& text) {
        const auto value = whole_number_in<std::uint64_t>(text);
        if (!value || *value < low || *value > high)
          refuse_value(option, text, fmt::format("a whole number from {} to {}, in digits", low, high));
        return std::string();
      },
      "");
}

void require_valid(const std::vector<Problem>& violations) {
  if (violations.empty()) return;
  Problem first = violations.front();
  first.path = option_name(first.path);
  throw CaseError("command line", first);
}

Vec3 direction_of(const std::vector<double>& numbers, const char* option) {
  const Vec3 direction(numbers.data());
  if (!is_direction(std::span<const double, 3>(numbers.data(), 3))) {
    throw CaseError("command line", option, fmt::format("{:g} {:g} {:g}", numbers[0], numbers[1], numbers[2]),
                    kDirectionText);
  }
  return direction;
}

}  // namespace incise::cli
