#include "arguments.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace incise::studio {

using Json = nlohmann::ordered_json;

std::string text_argument(const Json& arguments, const char* name) {
  return argument<std::string>(arguments, name, "a text");
}

double positive_argument(const Json& arguments, const char* name) {
  const auto value = argument<double>(arguments, name, "a number above 0");
  if (std::isfinite(value) && value > 0.0) return value;
  throw CaseError("request", name, arguments.at(name).dump().substr(0, 80), "a number above 0");
}

std::uint64_t seed_argument(const Json& arguments, const char* name) {
  const Json given = argument<Json>(arguments, name, "a whole number of at least 0");
  if (given.is_number_unsigned()) return given.get<std::uint64_t>();
  throw CaseError("request", name, given.dump().substr(0, 80), "a whole number of at least 0");
}

int count_argument(const Json& arguments, const char* name) {
  constexpr std::uint64_t kMost = 1'000'000'000;
  const std::uint64_t count = seed_argument(arguments, name);
  if (count > kMost) throw CaseError("request", name, fmt::format("{}", count), fmt::format("at most {}", kMost));
  return static_cast<int>(count);
}

Points points_argument(const Json& arguments, const char* name) {
  Points points;
  for (const auto& p : argument<std::vector<std::array<double, 3>>>(arguments, name, "a list of [x, y, z]"))
    points.emplace_back(p[0], p[1], p[2]);
  return points;
}

std::vector<Vec2> pixels_argument(const Json& arguments, const char* name) {
  std::vector<Vec2> pixels;
  for (const auto& p : argument<std::vector<std::array<double, 2>>>(arguments, name, "a list of [u, v]"))
    pixels.emplace_back(p[0], p[1]);
  return pixels;
}

}  // namespace incise::studio
