#pragma once

#include <incise/core/random.hpp>

#include <array>

namespace incise {

/// An irregular tumour edge seen from above, as a closed star-shaped curve:
/// r(angle) = radius (1 + Σ amplitude_n cos(n angle + phase_n)), n = 2..6. Harmonic 1 would only shift it.
struct TumorStar {
  double radius_mm = 10.0;
  std::array<double, 5> amplitude{};  ///< of harmonics 2..6, relative to the radius
  std::array<double, 5> phase{};      ///< of harmonics 2..6, radians

  [[nodiscard]] double radius_at_mm(double angle) const;  ///< @param angle  radians
};

/// Draws a random edge; lower harmonics are stronger.
/// @param diameter_mm   mean; > 0.
/// @param irregularity  sum of the amplitudes; [0, 0.5].
/// @throws InvalidArgument if either is out of range.
[[nodiscard]] TumorStar draw_tumor_star(double diameter_mm, double irregularity, Random& random);

}  // namespace incise
