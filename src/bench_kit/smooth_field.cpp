#include <incise/bench_kit/smooth_field.hpp>
#include <incise/core/units.hpp>

#include <cmath>

namespace incise {

SmoothField::SmoothField(double wave_mm, Random& random) {
  for (Wave& wave : waves_) {
    Vec3 heading;
    for (int axis = 0; axis < 3; ++axis) heading[axis] = random.normal();
    wave.per_mm = 2.0 * units::kPi / (wave_mm * random.uniform(0.7, 1.5)) * heading.normalized();
    wave.phase = random.uniform(0.0, 2.0 * units::kPi);
  }
}

double SmoothField::at(const Vec3& p) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) sum += std::cos(wave.per_mm.dot(p) + wave.phase);
  return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
}

}  // namespace incise
