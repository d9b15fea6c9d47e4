#pragma once

#include <incise/core/random.hpp>
#include <incise/geometry/types.hpp>

#include <array>

namespace incise {

/// A smooth random field in space: the sum of waves in random directions. Mean 0, standard deviation 1.
class SmoothField {
 public:
  /// @param wave_mm  reference wavelength, > 0; the waves are 0.7 to 1.5 times as long.
  SmoothField(double wave_mm, Random& random);
  [[nodiscard]] double at(const Vec3& p) const;

 private:
  struct Wave {
    Vec3 per_mm = Vec3::Zero();
    double phase = 0.0;
  };
  std::array<Wave, 12> waves_;
};

}  // namespace incise
