#pragma once

#include <incise/core/names.hpp>
#include <incise/core/random.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace incise {

/// How a parameter is drawn.
enum class DrawnAs {
  Uniform,    ///< between a and b
  Normal,     ///< mean a, standard deviation b, redrawn until within the limits
  LogNormal,  ///< median a, standard deviation b of the natural logarithm, redrawn until within the limits
};
inline constexpr std::array<std::string_view, 3> kDrawnAsNames{"uniform", "normal", "lognormal"};
[[nodiscard]] constexpr Names names_of(DrawnAs) {
  return kDrawnAsNames;
}

/// One hidden parameter of a virtual specimen.
template <class Specimen>
struct HiddenParameter {
  std::string_view name;     ///< its key in a specimen file; units at the end
  double Specimen::*member;  ///< the place it has
  DrawnAs drawn_as;
  double a, b;       ///< of the spread
  double low, high;  ///< what a specimen file may say, both included
  std::string_view meaning;
  std::string_view source;    ///< of value and spread; "chosen" where nobody has published one
  std::string_view shows_in;  ///< the reading through which it shows; "none"
};

/// A stream of random numbers of its own for each name (FNV-1a): a new parameter leaves the others as they were.
[[nodiscard]] std::uint64_t stream_of(std::uint64_t seed, std::string_view name);

/// A value at random, within the limits. @pre the limits hold a part of the spread.
template <class Specimen>
[[nodiscard]] double drawn(const HiddenParameter<Specimen>& spec, std::uint64_t seed) {
  Random random(stream_of(seed, spec.name));
  if (spec.drawn_as == DrawnAs::Uniform) return random.uniform(spec.a, spec.b);
  for (;;) {
    const double z = random.normal();
    const double value = spec.drawn_as == DrawnAs::Normal ? spec.a + spec.b * z : spec.a * std::exp(spec.b * z);
    if (value >= spec.low && value <= spec.high) return value;
  }
}

}  // namespace incise
