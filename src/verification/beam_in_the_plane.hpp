#pragma once

#include <incise/geometry/types.hpp>

#include <vector>

namespace incise {

/// A slender beam clamped at the origin along +x, with a dead force across it at its tip. Stiffnesses are those of the
/// cross-section; an infinite axial and shear stiffness makes it Euler's elastica.
struct PlaneBeam {
  double length_mm = 1.0;
  double bending_stiffness = 1.0;  ///< E I
  double axial_stiffness = 0.0;    ///< E A; 0: does not stretch
  double shear_stiffness = 0.0;    ///< 5/6 G A; 0: does not shear
  double force_mn = 0.0;           ///< at the tip, downwards
};

/// Points (x, z) of the bent centre line at `steps` + 1 equal arc lengths: Reissner's beam (1972), moment balance m' =
/// F x' integrated by Runge-Kutta from the clamp, whose moment is found by bisection so that the tip has none.
[[nodiscard]] std::vector<Vec2> bent_line(const PlaneBeam& beam, int steps = 400);

}  // namespace incise
