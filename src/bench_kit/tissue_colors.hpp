#pragma once

#include <incise/bench_kit/smooth_field.hpp>
#include <incise/geometry/picture.hpp>
#include <incise/geometry/types.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace incise {

/// A colour that is mixed linearly, 0 to 255 a channel.
using Paint = Vec3;
inline const Paint kTissuePaint(196.0, 138.0, 130.0);
inline const Paint kWallPaint(70.0, 40.0, 38.0);  // cut muscle, in the shadow of the kerf
inline const Paint kDeepPaint(46.0, 18.0, 18.0);  // the bottom of the kerf
inline const Paint kCookedPaint(226.0, 212.0, 190.0);
inline const Paint kCharPaint(38.0, 30.0, 28.0);
inline const Paint kBloodPaint(104.0, 52.0, 50.0);
inline const Paint kGlarePaint(250.0, 246.0, 240.0);
inline const Paint kRedInk(208.0, 22.0, 30.0);
inline const Paint kGreenInk(26.0, 158.0, 62.0);
inline const Paint kTablePaint(70.0, 96.0, 122.0);  // a blue drape

/// The grain of tissue: lightness at a place, mm; mean 1.
class TissueGrain {
 public:
  explicit TissueGrain(std::uint64_t seed)
      : random_(seed ^ 0x27d4eb2fULL), mottle_(6.0, random_), papillae_(1.1, random_) {}
  [[nodiscard]] double at(const Vec3& rest) const { return 1.0 + 0.05 * mottle_.at(rest) + 0.035 * papillae_.at(rest); }

 private:
  Random random_;
  SmoothField mottle_;
  SmoothField papillae_;
};

inline std::uint8_t channel(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}
inline std::uint8_t* pixel_at(ColorPicture& picture, int u, int v) {
  return picture.rgb.data() +
         3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(u));
}
inline void put(std::uint8_t* pixel, const Paint& paint) {
  for (int c = 0; c < 3; ++c) pixel[c] = channel(paint[c]);
}
/// Lays ink over a pixel. @param cover  in [0, 1]; even at 1 the grain beneath shows a little.
inline void lay(std::uint8_t* pixel, const Paint& ink, double cover) {
  for (int c = 0; c < 3; ++c) pixel[c] = channel((1.0 - cover) * pixel[c] + cover * (0.92 * ink[c] + 0.08 * pixel[c]));
}

}  // namespace incise
