#pragma once

#include <incise/core/random.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/imaging/picture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace incise::testing {

using Rgb = std::array<double, 3>;  ///< sRGB, [0, 255]

/// A line painted on the tissue, in mm of the picture's plane (x right, y up, origin at the lower left pixel).
struct PaintedLine {
  Contour course;  ///< where it runs; z is not looked at
  double width_mm = 0.15;
  Rgb color{30, 160, 60};
  /// A band that lies outside of a closed course, whose inner border is the course itself; else the course is its
  /// middle.
  bool is_outside = false;
  /// Stretches left out: start and length along the course, mm. Ends are cut square.
  std::vector<std::pair<double, double>> gaps_mm;
};

/// A photograph to be drawn.
struct PaintedPhoto {
  int width = 1200;
  int height = 1200;
  double mm_per_pixel = 0.03;
  Rgb tissue{186, 112, 100};
  double mottle = 0.10;            ///< share by which the tissue's colour wanders
  double shading = 0.35;           ///< share of the light lost towards one corner
  double blur_px = 0.9;            ///< standard deviation of the lens
  double noise = 4.0;              ///< standard deviation, grey levels
  int glare_spots = 12;            ///< wet highlights, of 4 to 12 pixels radius
  std::vector<PaintedLine> lines;  ///< later ones over earlier ones
  std::uint64_t seed = 1;
};

namespace painter_detail {

inline double to_linear(double c) {
  return c <= 10.31475 ? c / 255.0 / 12.92 : std::pow((c / 255.0 + 0.055) / 1.055, 2.4);
}
inline double to_srgb(double x) {
  const double y = std::clamp(x, 0.0, 1.0);
  return 255.0 * (y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1.0 / 2.4) - 0.055);
}

/// Linear light, row by row.
struct Light {
  int width, height;
  std::vector<std::array<float, 3>> values;
  std::array<float, 3>& at(int u, int v) {
    return values[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)];
  }
};

/// Distance in pixels from every pixel near a course to it, and where along it the nearest place lies.
struct Nearness {
  std::vector<float> distance_px;
  std::vector<float> along_mm;
};

inline Nearness nearness_to(const PaintedPhoto& photo, const PaintedLine& line) {
  const auto pixels = static_cast<std::size_t>(photo.width) * static_cast<std::size_t>(photo.height);
  Nearness near{std::vector<float>(pixels, std::numeric_limits<float>::infinity()), std::vector<float>(pixels, 0.0F)};
  const auto place = [&](const Vec3& p) {
    return Vec2(p.x() / photo.mm_per_pixel, photo.height - 1 - p.y() / photo.mm_per_pixel);
  };
  const double reach = line.width_mm / photo.mm_per_pixel + 3.0;
  const std::size_t n = line.course.points.size();
  double along = 0.0;
  for (std::size_t i = 0; i + (line.course.is_closed ? 0 : 1) < n; ++i) {
    const Vec2 a = place(line.course.points[i]);
    const Vec2 b = place(line.course.points[(i + 1) % n]);
    const Vec2 d = b - a;
    const double length = d.norm();
    const int left = std::max(0, static_cast<int>(std::min(a.x(), b.x()) - reach)),
              right = std::min(photo.width - 1, static_cast<int>(std::max(a.x(), b.x()) + reach));
    const int top = std::max(0, static_cast<int>(std::min(a.y(), b.y()) - reach)),
              low = std::min(photo.height - 1, static_cast<int>(std::max(a.y(), b.y()) + reach));
    for (int v = top; v <= low; ++v) {
      for (int u = left; u <= right; ++u) {
        const Vec2 p(u, v);
        const double t = length > 0.0 ? std::clamp((p - a).dot(d) / (length * length), 0.0, 1.0) : 0.0;
        const double distance = (p - a - t * d).norm();
        const auto k =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(photo.width) + static_cast<std::size_t>(u);
        if (distance >= static_cast<double>(near.distance_px[k])) continue;
        near.distance_px[k] = static_cast<float>(distance);
        near.along_mm[k] = static_cast<float>(along + t * length * photo.mm_per_pixel);
      }
    }
    along += length * photo.mm_per_pixel;
  }
  return near;
}

inline void paint(Light& light, const PaintedPhoto& photo, const PaintedLine& line) {
  const Nearness near = nearness_to(photo, line);
  const double width_px = line.width_mm / photo.mm_per_pixel;
  for (int v = 0; v < photo.height; ++v) {
    for (int u = 0; u < photo.width; ++u) {
      const auto k = static_cast<std::size_t>(v) * static_cast<std::size_t>(photo.width) + static_cast<std::size_t>(u);
      if (!std::isfinite(near.distance_px[k])) continue;
      const double along = near.along_mm[k];
      const bool is_gap = std::any_of(line.gaps_mm.begin(), line.gaps_mm.end(), [&](const auto& gap) {
        return along >= gap.first && along <= gap.first + gap.second;
      });
      if (is_gap) continue;
      double cover = std::clamp(0.5 + 0.5 * width_px - static_cast<double>(near.distance_px[k]), 0.0, 1.0);
      if (line.is_outside) {
        const Vec3 p(u * photo.mm_per_pixel, (photo.height - 1 - v) * photo.mm_per_pixel, 0.0);
        const double outside = contains_in_view(line.course, p, -Vec3::UnitZ())
                                   ? -static_cast<double>(near.distance_px[k])
                                   : static_cast<double>(near.distance_px[k]);
        cover = std::clamp(0.5 + outside, 0.0, 1.0) * std::clamp(0.5 + width_px - outside, 0.0, 1.0);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        float& value = light.at(u, v)[c];
        value += static_cast<float>(cover * (to_linear(line.color[c]) - static_cast<double>(value)));
      }
    }
  }
}

inline void blur(Light& light, double sigma) {
  if (sigma <= 0.0) return;
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<float> kernel;
  float sum = 0.0F;
  for (int k = -reach; k <= reach; ++k)
    sum += kernel.emplace_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
  for (float& weight : kernel) weight /= sum;
  for (const bool is_across : {true, false}) {
    Light from = light;
    for (int v = 0; v < light.height; ++v) {
      for (int u = 0; u < light.width; ++u) {
        std::array<float, 3> total{};
        for (int k = -reach; k <= reach; ++k) {
          const auto& value = from.at(is_across ? std::clamp(u + k, 0, light.width - 1) : u,
                                      is_across ? v : std::clamp(v + k, 0, light.height - 1));
          for (std::size_t c = 0; c < 3; ++c) total[c] += kernel[static_cast<std::size_t>(k + reach)] * value[c];
        }
        light.at(u, v) = total;
      }
    }
  }
}

inline Light bare_tissue(const PaintedPhoto& photo, Random& random) {
  Light light{photo.width, photo.height, {}};
  light.values.resize(static_cast<std::size_t>(photo.width) * static_cast<std::size_t>(photo.height));
  // Mottle: a few waves of random direction and phase, of 2 to 12 mm, one set for the redness and one for the rest.
  struct Wave {
    double ku, kv, phase;
  };
  std::array<Wave, 10> waves{};
  for (Wave& w : waves) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double k = 2.0 * std::numbers::pi * photo.mm_per_pixel / random.uniform(2.0, 12.0);
    w = {k * std::cos(angle), k * std::sin(angle), random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
  for (int v = 0; v < photo.height; ++v) {
    for (int u = 0; u < photo.width; ++u) {
      double brightness = 0.0, redness = 0.0;
      for (std::size_t i = 0; i < waves.size(); ++i) {
        (i < 5 ? brightness : redness) += std::sin(waves[i].ku * u + waves[i].kv * v + waves[i].phase) / 2.2;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const double share = 1.0 + photo.mottle * (brightness - (c == 0 ? 0.0 : 0.7 * redness));
        light.at(u, v)[c] = static_cast<float>(to_linear(photo.tissue[c]) * share);
      }
    }
  }
  return light;
}

inline void shade_and_glare(Light& light, const PaintedPhoto& photo, Random& random) {
  for (int v = 0; v < photo.height; ++v) {
    for (int u = 0; u < photo.width; ++u) {
      const double share =
          1.0 - photo.shading * 0.5 * (static_cast<double>(u) / photo.width + static_cast<double>(v) / photo.height);
      for (float& value : light.at(u, v)) value *= static_cast<float>(share);
    }
  }
  for (int i = 0; i < photo.glare_spots; ++i) {
    Vec2 center(random.uniform(0.0, photo.width), random.uniform(0.0, photo.height));
    if (i % 2 == 0 && !photo.lines.empty()) {  // half of them on a line
      const auto& points = photo.lines[static_cast<std::size_t>(i / 2) % photo.lines.size()].course.points;
      const Vec3& p = points[random.below(points.size())];
      center = Vec2(p.x() / photo.mm_per_pixel, photo.height - 1 - p.y() / photo.mm_per_pixel);
    }
    const double radius = random.uniform(4.0, 12.0);
    for (int v = std::max(0, static_cast<int>(center.y() - 2 * radius));
         v < std::min<double>(photo.height, center.y() + 2 * radius); ++v) {
      for (int u = std::max(0, static_cast<int>(center.x() - 2 * radius));
           u < std::min<double>(photo.width, center.x() + 2 * radius); ++u) {
        const double extra = 3.0 / (1.0 + std::exp(2.0 * ((Vec2(u, v) - center).norm() - radius)));
        for (float& value : light.at(u, v)) value += static_cast<float>(extra);
      }
    }
  }
}

}  // namespace painter_detail

/// Draws the photograph: tissue, lines (square pixels, in linear light), shading, highlights, lens, noise. The same
/// seed gives the same picture.
inline ColorPicture paint_photo(const PaintedPhoto& photo) {
  using namespace painter_detail;
  Random random(photo.seed);
  Light light = bare_tissue(photo, random);
  for (const PaintedLine& line : photo.lines) paint(light, photo, line);
  shade_and_glare(light, photo, random);
  for (auto& pixel : light.values) {
    for (float& value : pixel) value = std::min(value, 1.5F);  // a sensor is full at some point
  }
  blur(light, photo.blur_px);
  ColorPicture picture{photo.width, photo.height, {}};
  picture.rgb.reserve(3 * light.values.size());
  for (const auto& pixel : light.values) {
    for (const float value : pixel) {
      picture.rgb.push_back(static_cast<std::uint8_t>(
          std::clamp(to_srgb(static_cast<double>(value)) + photo.noise * random.normal(), 0.0, 254.4) + 0.5));
    }
  }
  return picture;
}

}  // namespace incise::testing
