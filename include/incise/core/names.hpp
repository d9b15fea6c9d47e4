#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace incise {

using Names = std::span<const std::string_view>;

/// An enum whose values have names: a function `names_of` beside it returns them in the order of the values, which
/// start at 0.
///
///     enum class Shape { Round, Square };
///     inline constexpr std::array<std::string_view, 2> kShapeNames{"round", "square"};
///     [[nodiscard]] constexpr Names names_of(Shape) { return kShapeNames; }
template <class E>
concept Named = std::is_enum_v<E> && requires(E value) {
  { names_of(value) } -> std::convertible_to<Names>;
};

/// Returns the name of a value, or "unknown" for a number that is not a value of the enum.
template <Named E>
[[nodiscard]] constexpr std::string_view to_string(E value) {
  const Names names = names_of(value);
  const auto place = static_cast<std::size_t>(value);
  return place < names.size() ? names[place] : "unknown";
}

/// Returns the value with this name; nullopt if there is none.
template <Named E>
[[nodiscard]] constexpr std::optional<E> value_of(std::string_view name) {
  const Names names = names_of(E{});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<E>(i);
  return std::nullopt;
}

/// Returns all values, in their order.
template <Named E>
[[nodiscard]] constexpr auto values_of() {
  std::array<E, Names(names_of(E{})).size()> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<E>(i);
  return values;
}

/// Returns the names as a list in a sentence: "ok, caution or refused".
[[nodiscard]] std::string choices(Names names);

}  // namespace incise
