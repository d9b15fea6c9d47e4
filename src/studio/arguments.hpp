#pragma once

#include <incise/core/error.hpp>
#include <incise/core/names.hpp>
#include <incise/geometry/types.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace incise::studio {

/// Returns an argument of a call. @param expected  for the message.
/// @throws CaseError if it is missing or of another type.
template <class Value>
Value argument(const nlohmann::ordered_json& arguments, const char* name, const char* expected) {
  const auto found = arguments.find(name);
  try {
    if (found != arguments.end()) return found->get<Value>();
  } catch (const nlohmann::ordered_json::exception&) {
  }
  throw CaseError("request", name, found == arguments.end() ? "nothing" : found->dump().substr(0, 80), expected);
}

/// As argument, with a default for an argument that is left out.
template <class Value>
Value argument_or(const nlohmann::ordered_json& arguments, const char* name, const char* expected, Value otherwise) {
  return arguments.contains(name) ? argument<Value>(arguments, name, expected) : otherwise;
}

/// Returns an argument that is one word of a list. @throws CaseError
template <Named E>
E word_argument(const nlohmann::ordered_json& arguments, const char* name) {
  const std::string expected = choices(names_of(E{}));
  const auto word = argument<std::string>(arguments, name, expected.c_str());
  if (const auto value = value_of<E>(word)) return *value;
  throw CaseError("request", name, "'" + word.substr(0, 40) + "'", expected);
}

/// @throws CaseError
[[nodiscard]] std::string text_argument(const nlohmann::ordered_json& arguments, const char* name);
/// A finite number above 0. @throws CaseError
[[nodiscard]] double positive_argument(const nlohmann::ordered_json& arguments, const char* name);
/// A whole number >= 0. @throws CaseError
[[nodiscard]] std::uint64_t seed_argument(const nlohmann::ordered_json& arguments, const char* name);
/// A whole number from 0 to a billion. @throws CaseError
[[nodiscard]] int count_argument(const nlohmann::ordered_json& arguments, const char* name);
/// A list of [x, y, z]. @throws CaseError
[[nodiscard]] Points points_argument(const nlohmann::ordered_json& arguments, const char* name);
/// A list of [u, v]. @throws CaseError
[[nodiscard]] std::vector<Vec2> pixels_argument(const nlohmann::ordered_json& arguments, const char* name);

}  // namespace incise::studio
