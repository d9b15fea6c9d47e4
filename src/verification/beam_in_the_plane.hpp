#pragma once

#include <incise/geometry/types.hpp>

#include <vector>

namespace incise {

/// A slender beam clamped at the origin along +x, with a dead force across it at its tip. Stiffnesses are those of the
/// cross-section. Without stretch and shear it is Euler's elastica.
struct PlaneBeam {
  double length_mm = 1.0;
  double bending_stiffness = 1.0;  ///< E I, mN mm²
  double axial_stiffness = 0.0;    ///< E A, mN; 0: does not stretch
  double shear_stiffness = 0.0;    ///< 5/6 G A, mN; 0: does not shear
  double force_mn = 0.0;           ///< at the tip, downwards
};

/// Returns the points (x, z), mm, of the bent centre line at `steps` + 1 equally spaced arc lengths (at rest).
/// Reissner's beam (1972): integrates the moment balance m' = F x' by Runge-Kutta from the clamp; bisection finds the
/// clamp's moment for which the tip has none.
[[nodiscard]] std::vector<Vec2> bent_line(const PlaneBeam& beam, int steps = 400);

}  // namespace incise
