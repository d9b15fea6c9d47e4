#include "option_checks.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace incise::cli {
namespace {

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || at != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <typename IsAllowed>
CLI::Validator check_of(const std::string& option, const std::string& expected, const IsAllowed& is_allowed) {
  return CLI::Validator(
      [option, expected, is_allowed](std::string& text) {
        const std::optional<double> value = number_in(text);
        if (!value || !is_allowed(*value))
          throw CaseError("command line", option, value ? text : "'" + text + "'", expected);
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

void require_valid(const std::vector<std::string>& violations) {
  if (violations.empty()) return;
  const std::string& text = violations.front();
  const std::string kFound = ": found ";
  const std::string kExpected = ", expected ";
  const std::size_t found = text.find(kFound);
  const std::size_t expected = text.find(kExpected, found == std::string::npos ? 0 : found);
  if (found == std::string::npos || expected == std::string::npos)
    throw CaseError("command line", "", text, "usable settings");
  std::string option = "--" + text.substr(0, found);
  std::replace(option.begin(), option.end(), '_', '-');
  const std::size_t value = found + kFound.size();
  throw CaseError("command line", option, text.substr(value, expected - value),
                  text.substr(expected + kExpected.size()));
}

}  // namespace incise::cli
