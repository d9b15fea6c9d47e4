#pragma once

#include <incise/geometry/picture.hpp>

#include <algorithm>
#include <cmath>

namespace incise::testing {

/// The picture as another camera would have taken it: each pixel is taken from where `source_of` says, between pixels
/// in proportion; beyond the rim the rim's own pixels go on.
template <typename SourceOf>
ColorPicture warped(const ColorPicture& picture, const SourceOf& source_of) {
  ColorPicture result = picture;
  const auto value = [&](int u, int v, int c) {
    u = std::clamp(u, 0, picture.width - 1);
    v = std::clamp(v, 0, picture.height - 1);
    return static_cast<double>(picture.rgb[static_cast<std::size_t>((v * picture.width + u) * 3 + c)]);
  };
  for (int v = 0; v < picture.height; ++v) {
    for (int u = 0; u < picture.width; ++u) {
      const Vec2 p = source_of(Vec2(u, v));
      const int iu = static_cast<int>(std::floor(p.x())), iv = static_cast<int>(std::floor(p.y()));
      const double a = p.x() - iu, b = p.y() - iv;
      for (int c = 0; c < 3; ++c) {
        const double mixed = (1 - b) * ((1 - a) * value(iu, iv, c) + a * value(iu + 1, iv, c)) +
                             b * ((1 - a) * value(iu, iv + 1, c) + a * value(iu + 1, iv + 1, c));
        result.rgb[static_cast<std::size_t>((v * picture.width + u) * 3 + c)] =
            static_cast<std::uint8_t>(std::lround(mixed));
      }
    }
  }
  return result;
}

/// A pinhole camera above the picture's middle, tilted.
struct TiltedCamera {
  double tilt_rad = 0.0;
  double azimuth_rad = 0.0;  ///< of the direction in which the tissue falls away
  double distance_mm = 300.0;
};
inline ColorPicture seen_obliquely(const ColorPicture& picture, const TiltedCamera& camera, double mm_per_pixel) {
  const Vec2 middle(0.5 * (picture.width - 1), 0.5 * (picture.height - 1));
  const Vec2 along(std::cos(camera.azimuth_rad), std::sin(camera.azimuth_rad)), across(-along.y(), along.x());
  const double f = camera.distance_mm / mm_per_pixel;
  return warped(picture, [&](const Vec2& pixel) {
    const Vec2 p = pixel - middle;
    const double v = along.dot(p), u = across.dot(p);
    const double y = v * camera.distance_mm / (f * std::cos(camera.tilt_rad) - v * std::sin(camera.tilt_rad));
    const double x = u * (camera.distance_mm + y * std::sin(camera.tilt_rad)) / f;
    return Vec2(middle + (y * along + x * across) / mm_per_pixel);
  });
}

/// Barrel distortion. @param share  by which a corner is drawn in, of its distance from the middle
inline ColorPicture through_barrel(const ColorPicture& picture, double share) {
  const Vec2 middle(0.5 * (picture.width - 1), 0.5 * (picture.height - 1));
  return warped(picture, [&](const Vec2& pixel) {
    const Vec2 p = (pixel - middle) / middle.norm();
    return Vec2(middle + middle.norm() * p * (1.0 + share * p.squaredNorm()));
  });
}

}  // namespace incise::testing
