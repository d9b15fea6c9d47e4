#include <incise/core/describe.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace incise {

bool contains(const Range& range, double value) {
  if (!std::isfinite(value)) return false;
  const bool is_above = range.is_least_open ? value > range.least : value >= range.least;
  const bool is_below = range.is_most_open ? value < range.most : value <= range.most;
  return is_above && is_below;
}

std::string describe(const Range& range) {
  constexpr double kLargestInt =
      std::numeric_limits<std::int32_t>::max();  // a bound that only the type sets is not stated
  const bool has_least = std::isfinite(range.least) && range.least > -kLargestInt;
  const bool has_most = std::isfinite(range.most) && range.most < kLargestInt;
  if (!has_least && !has_most) return "a number";
  if (!has_most) {
    return range.is_least_open ? fmt::format("a number above {}", range.least)
                               : fmt::format("a number of {} or more", range.least);
  }
  if (!has_least) {
    return range.is_most_open ? fmt::format("a number below {}", range.most)
                              : fmt::format("a number of {} or less", range.most);
  }
  return fmt::format("a number in {}{}, {}{}", range.is_least_open ? '(' : '[', range.least, range.most,
                     range.is_most_open ? ')' : ']');
}

void Visitor::refuse(const Field& field, const std::string& found, const std::string& expected) const {
  core_detail::throw_invalid_argument("describe",
                                      fmt::format("{}: found {}, expected {}", field.name, found, expected));
}

std::size_t Visitor::key(std::size_t& place, std::span<const Field> keys) {
  std::vector<std::string_view> names;
  for (const Field& key : keys) names.push_back(key.name);
  choice(Field{"kind", "Which of the keys is given."}, place, names);
  return 1;
}

}  // namespace incise
