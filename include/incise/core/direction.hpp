#pragma once

#include <cmath>
#include <span>

namespace incise {

/// Whether three numbers are a direction: finite, with a length in [1e-6, 1e6], which is safe to divide by and to
/// square. The length has no other meaning.
[[nodiscard]] inline bool is_direction(std::span<const double, 3> v) {
  constexpr double kShortest = 1e-6, kLongest = 1e6;
  const double length = std::hypot(v[0], v[1], v[2]);
  return length >= kShortest && length <= kLongest;  // false where a number is not finite
}
inline constexpr const char* kDirectionText = "a direction, of a length in [1e-6, 1e6]";

}  // namespace incise
