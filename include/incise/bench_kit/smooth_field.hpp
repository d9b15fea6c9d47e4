#pragma once

#include <incise/core/random.hpp>
#include <incise/geometry/types.hpp>

#include <array>

namespace incise {

/// A smooth random number at every place: the sum of waves in random directions. Mean 0, standard deviation 1.
class SmoothField {
 public:
  /// @param wave_mm  the middle of the waves' lengths, which lie between 0.7 and 1.5 of it; > 0.
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
