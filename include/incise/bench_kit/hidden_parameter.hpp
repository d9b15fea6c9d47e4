#pragma once

#include <incise/core/names.hpp>
#include <incise/core/random.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace incise {

/// The distribution from which a parameter is drawn.
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
  double Specimen::*member;  ///< its member of a specimen
  DrawnAs drawn_as;
  double a, b;       ///< of the distribution: see DrawnAs
  double low, high;  ///< limits in a specimen file, both included
  std::string_view meaning;
  std::string_view source;    ///< of value and spread; "chosen" if none is published
  std::string_view shows_in;  ///< the reading that reveals it, or "none"
};

/// Returns the seed of a separate random stream for each name (FNV-1a), so a new parameter does not change the others.
[[nodiscard]] inline std::uint64_t stream_of(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 1469598103934665603ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash ^ (seed * 0x9E3779B97F4A7C15ULL);
}

/// Returns a random value of the parameter. Normal and lognormal draws are repeated until one is within the limits; a
/// uniform draw is not checked. @pre the limits contain a part of the distribution; for a uniform one, all of it.
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
