#include "verification/beam_in_the_plane.hpp"

#include <cmath>

namespace incise {
namespace {

/// x, z, angle of the section, bending moment.
using State = Eigen::Vector4d;

State slope(const PlaneBeam& beam, const State& s) {
  const Vec2 along(std::cos(s[2]), std::sin(s[2]));
  const Vec2 across(-along[1], along[0]);
  // The force (0, -F) is the same in every section.
  const double stretch = beam.axial_stiffness > 0.0 ? -beam.force_mn * along[1] / beam.axial_stiffness : 0.0;
  const double shear = beam.shear_stiffness > 0.0 ? -beam.force_mn * across[1] / beam.shear_stiffness : 0.0;
  const Vec2 tangent = (1.0 + stretch) * along + shear * across;
  return {tangent[0], tangent[1], s[3] / beam.bending_stiffness, beam.force_mn * tangent[0]};
}

std::vector<State> integrate(const PlaneBeam& beam, double clamp_moment, int steps) {
  std::vector<State> states{State(0.0, 0.0, 0.0, clamp_moment)};
  const double h = beam.length_mm / steps;
  for (int i = 0; i < steps; ++i) {
    const State& s = states.back();
    const State a = slope(beam, s);
    const State b = slope(beam, s + 0.5 * h * a);
    const State c = slope(beam, s + 0.5 * h * b);
    const State d = slope(beam, s + h * c);
    states.push_back(s + h / 6.0 * (a + 2.0 * b + 2.0 * c + d));
  }
  return states;
}

}  // namespace

std::vector<Vec2> bent_line(const PlaneBeam& beam, int steps) {
  // Without a moment at the clamp, the moment at the tip is positive; with 1.5 times the straight beam's it is
  // negative.
  double low = -1.5 * beam.force_mn * beam.length_mm;
  double high = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (integrate(beam, middle, steps).back()[3] > 0.0 ? high : low) = middle;
  }
  std::vector<Vec2> line;
  for (const State& s : integrate(beam, 0.5 * (low + high), steps)) line.emplace_back(s[0], s[1]);
  return line;
}

}  // namespace incise
