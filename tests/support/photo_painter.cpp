#include "support/photo_painter.hpp"

#include <incise/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace incise::testing {
namespace {

double to_linear(double c) {
  return c <= 10.31475 ? c / 255.0 / 12.92 : std::pow((c / 255.0 + 0.055) / 1.055, 2.4);
}

std::array<float, 3> to_linear(const Rgb& color) {
  return {static_cast<float>(to_linear(color[0])), static_cast<float>(to_linear(color[1])),
          static_cast<float>(to_linear(color[2]))};
}

/// Linear light, row by row, three floats a pixel.
struct Light {
  int width, height;
  std::vector<float> values;
  Light(int w, int h)
      : width(w), height(h), values(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0F) {}
  float* row(int v) { return values.data() + 3 * static_cast<std::size_t>(v) * static_cast<std::size_t>(width); }
  float* at(int u, int v) { return row(v) + 3 * u; }
};

Vec2 pixel_of(const PaintedPhoto& photo, const Vec3& p) {
  return {p.x() / photo.mm_per_pixel, photo.height - 1 - p.y() / photo.mm_per_pixel};
}

/// Part of the picture: pixels left … right - 1, top … low - 1.
struct Window {
  int left, top, right, low;
  [[nodiscard]] int width() const { return std::max(0, right - left); }
  [[nodiscard]] std::size_t place(int u, int v) const {
    return static_cast<std::size_t>(v - top) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(u - left);
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width()) * static_cast<std::size_t>(std::max(0, low - top));
  }
};

Window window_about(const Vec2& a, const Vec2& b, double reach, const Window& within) {
  return {std::max(within.left, static_cast<int>(std::floor(std::min(a.x(), b.x()) - reach))),
          std::max(within.top, static_cast<int>(std::floor(std::min(a.y(), b.y()) - reach))),
          std::min(within.right, static_cast<int>(std::ceil(std::max(a.x(), b.x()) + reach)) + 1),
          std::min(within.low, static_cast<int>(std::ceil(std::max(a.y(), b.y()) + reach)) + 1)};
}

/// A course in pixels; a closed one repeats its first point at the end.
std::vector<Vec2> pixels_along(const PaintedPhoto& photo, const Contour& course) {
  std::vector<Vec2> result;
  for (const Vec3& p : course.points) result.push_back(pixel_of(photo, p));
  if (course.is_closed) result.push_back(result.front());
  return result;
}

/// Squared distance in pixels from every pixel near a course to it, and where along it the nearest place lies.
struct Nearness {
  Window window;
  std::vector<float> squared_px;
  std::vector<float> along_mm;
};

Nearness nearness_to(const PaintedPhoto& photo, const std::vector<Vec2>& course, double reach) {
  Vec2 low = course.front(), high = course.front();
  for (const Vec2& p : course) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Nearness near{window_about(low, high, reach, {0, 0, photo.width, photo.height}), {}, {}};
  near.squared_px.assign(near.window.size(), std::numeric_limits<float>::infinity());
  near.along_mm.assign(near.window.size(), 0.0F);
  double along = 0.0;
  for (std::size_t i = 0; i + 1 < course.size(); ++i) {
    const Vec2 a = course[i];
    const Vec2 d = course[i + 1] - a;
    const double length = d.norm();
    const Vec2 per_length = length > 0.0 ? Vec2(d / (length * length)) : Vec2(0.0, 0.0);
    const Window box = window_about(a, course[i + 1], reach, near.window);
    for (int v = box.top; v < box.low; ++v) {
      std::size_t k = near.window.place(box.left, v);
      for (int u = box.left; u < box.right; ++u, ++k) {
        const double x = u - a.x(), y = v - a.y();
        const double t = std::clamp(x * per_length.x() + y * per_length.y(), 0.0, 1.0);
        const double dx = x - t * d.x(), dy = y - t * d.y();
        const auto squared = static_cast<float>(dx * dx + dy * dy);
        if (squared >= near.squared_px[k]) continue;
        near.squared_px[k] = squared;
        near.along_mm[k] = static_cast<float>((along + t * length) * photo.mm_per_pixel);
      }
    }
    along += length;
  }
  return near;
}

/// 1 for the pixels of a window whose centres lie inside a closed course (even-odd).
std::vector<std::uint8_t> inside_of(const std::vector<Vec2>& course, const Window& window) {
  std::vector<std::uint8_t> inside(window.size(), 0);
  std::vector<double> crossings;
  for (int v = window.top; v < window.low; ++v) {
    crossings.clear();
    for (std::size_t i = 0; i + 1 < course.size(); ++i) {
      const Vec2& a = course[i];
      const Vec2& b = course[i + 1];
      if ((a.y() <= v) == (b.y() <= v)) continue;
      crossings.push_back(a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int from = std::max(window.left, static_cast<int>(std::ceil(crossings[i])));
      const int to = std::min(window.right - 1, static_cast<int>(std::floor(crossings[i + 1])));
      for (int u = from; u <= to; ++u) inside[window.place(u, v)] = 1;
    }
  }
  return inside;
}

void mix(float* pixel, const std::array<float, 3>& color, double cover) {
  for (std::size_t c = 0; c < 3; ++c) pixel[c] += static_cast<float>(cover) * (color[c] - pixel[c]);
}

void paint(Light& light, const PaintedPhoto& photo, const PaintedLine& line) {
  const double width_px = line.width_mm / photo.mm_per_pixel;
  const std::vector<Vec2> course = pixels_along(photo, line.course);
  const Nearness near = nearness_to(photo, course, (line.is_outside ? width_px : 0.5 * width_px) + 2.0);
  const Window& window = near.window;
  const std::vector<std::uint8_t> inside =
      line.is_outside ? inside_of(course, window) : std::vector<std::uint8_t>(window.size(), 0);
  const std::array<float, 3> color = to_linear(line.color);
  for (int v = window.top; v < window.low; ++v) {
    for (int u = window.left; u < window.right; ++u) {
      const std::size_t k = window.place(u, v);
      if (!std::isfinite(near.squared_px[k])) continue;
      const double along = near.along_mm[k];
      const bool is_gap = std::any_of(line.gaps_mm.begin(), line.gaps_mm.end(), [&](const auto& gap) {
        return along >= gap.first && along <= gap.first + gap.second;
      });
      if (is_gap) continue;
      const double distance = std::sqrt(static_cast<double>(near.squared_px[k]));
      const double outside = inside[k] != 0 ? -distance : distance;
      const double cover = line.is_outside
                               ? std::clamp(0.5 + outside, 0.0, 1.0) * std::clamp(0.5 + width_px - outside, 0.0, 1.0)
                               : std::clamp(0.5 + 0.5 * width_px - distance, 0.0, 1.0);
      if (cover > 0.0) mix(light.at(u, v), color, cover);
    }
  }
}

/// A wave over the picture, sin(ku u + kv v + phase), from tables of its columns and rows.
struct Wave {
  std::vector<std::array<float, 2>> columns;  ///< sine, cosine of ku u + phase
  std::vector<std::array<float, 2>> rows;     ///< of kv v

  Wave(const PaintedPhoto& photo, double ku, double kv, double phase) {
    const auto table = [](int count, double k, double start) {
      std::vector<std::array<float, 2>> result;
      for (int i = 0; i < count; ++i)
        result.push_back({static_cast<float>(std::sin(k * i + start)), static_cast<float>(std::cos(k * i + start))});
      return result;
    };
    columns = table(photo.width, ku, phase);
    rows = table(photo.height, kv, 0.0);
  }
  [[nodiscard]] float at(int u, int v) const {
    const auto& c = columns[static_cast<std::size_t>(u)];
    const auto& r = rows[static_cast<std::size_t>(v)];
    return c[0] * r[1] + c[1] * r[0];
  }
};

/// Mottle: a few waves of random direction and phase, of 2 to 12 mm, one set for the redness and one for the rest.
Light bare_tissue(const PaintedPhoto& photo, Random& random) {
  Light light(photo.width, photo.height);
  constexpr std::size_t kOfEach = 5;
  std::vector<Wave> waves;
  for (std::size_t i = 0; i < 2 * kOfEach; ++i) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double k = 2.0 * std::numbers::pi * photo.mm_per_pixel / random.uniform(2.0, 12.0);
    waves.emplace_back(photo, k * std::cos(angle), k * std::sin(angle), random.uniform(0.0, 2.0 * std::numbers::pi));
  }
  const std::array<float, 3> tissue = to_linear(photo.tissue);
  const auto mottle = static_cast<float>(photo.mottle);
  for (int v = 0; v < photo.height; ++v) {
    float* pixel = light.row(v);
    for (int u = 0; u < photo.width; ++u, pixel += 3) {
      float brightness = 0.0F, redness = 0.0F;
      for (std::size_t i = 0; i < kOfEach; ++i) {
        brightness += waves[i].at(u, v) / 2.2F;
        redness += waves[kOfEach + i].at(u, v) / 2.2F;
      }
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = tissue[c] * (1.0F + mottle * (brightness - (c == 0 ? 0.0F : 0.7F * redness)));
    }
  }
  return light;
}

void lay_on_sheet(Light& light, const PaintedPhoto& photo) {
  if (!photo.specimen) return;
  const std::array<float, 3> sheet = to_linear(photo.sheet);
  const Window whole{0, 0, photo.width, photo.height};
  const std::vector<std::uint8_t> inside = inside_of(pixels_along(photo, *photo.specimen), whole);
  for (int v = 0; v < photo.height; ++v) {
    for (int u = 0; u < photo.width; ++u) {
      if (inside[whole.place(u, v)] == 0) mix(light.at(u, v), sheet, 1.0);
    }
  }
}

void shade(Light& light, const PaintedPhoto& photo) {
  for (int v = 0; v < photo.height; ++v) {
    float* pixel = light.row(v);
    for (int u = 0; u < photo.width; ++u, pixel += 3) {
      const auto share = static_cast<float>(
          1.0 - photo.shading * 0.5 * (static_cast<double>(u) / photo.width + static_cast<double>(v) / photo.height));
      for (std::size_t c = 0; c < 3; ++c) pixel[c] *= share;
    }
  }
}

/// Half of the highlights lie on a line.
void add_glare(Light& light, const PaintedPhoto& photo, Random& random) {
  for (int i = 0; i < photo.glare_spots; ++i) {
    Vec2 center(random.uniform(0.0, photo.width), random.uniform(0.0, photo.height));
    if (i % 2 == 0 && !photo.lines.empty()) {
      const auto& points = photo.lines[static_cast<std::size_t>(i / 2) % photo.lines.size()].course.points;
      center = pixel_of(photo, points[random.below(points.size())]);
    }
    const double radius = random.uniform(4.0, 12.0);
    const Window box = window_about(center, center, 2.0 * radius, {0, 0, photo.width, photo.height});
    for (int v = box.top; v < box.low; ++v) {
      for (int u = box.left; u < box.right; ++u) {
        const double extra = 3.0 / (1.0 + std::exp(2.0 * ((Vec2(u, v) - center).norm() - radius)));
        for (int c = 0; c < 3; ++c) light.at(u, v)[c] += static_cast<float>(extra);
      }
    }
  }
}

std::vector<float> bell(double sigma) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<float> kernel;
  float sum = 0.0F;
  for (int k = -reach; k <= reach; ++k)
    sum += kernel.emplace_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

/// Across, then down; what lies beyond the picture is as its rim.
void blur(Light& light, double sigma) {
  if (sigma <= 0.0) return;
  const std::vector<float> kernel = bell(sigma);
  const int reach = static_cast<int>(kernel.size() / 2);
  const std::size_t row_size = 3 * static_cast<std::size_t>(light.width);
  std::vector<float> padded(row_size + 6 * static_cast<std::size_t>(reach));
  for (int v = 0; v < light.height; ++v) {
    float* row = light.row(v);
    for (int u = -reach; u < light.width + reach; ++u) {
      const float* from = row + 3 * std::clamp(u, 0, light.width - 1);
      std::copy(from, from + 3, padded.begin() + 3 * (u + reach));
    }
    std::fill(row, row + row_size, 0.0F);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const float weight = kernel[k];
      const float* from = padded.data() + 3 * k;
      for (std::size_t i = 0; i < row_size; ++i) row[i] += weight * from[i];
    }
  }
  Light across = light;
  for (int v = 0; v < light.height; ++v) {
    float* row = light.row(v);
    std::fill(row, row + row_size, 0.0F);
    for (int k = -reach; k <= reach; ++k) {
      const float weight = kernel[static_cast<std::size_t>(k + reach)];
      const float* from = across.row(std::clamp(v + k, 0, light.height - 1));
      for (std::size_t i = 0; i < row_size; ++i) row[i] += weight * from[i];
    }
  }
}

/// Linear light to grey levels, from a table: within 0.05 of a level of the formula.
class Gamma {
 public:
  Gamma() {
    for (int i = 0; i <= kSteps + 1; ++i) {
      const double x = static_cast<double>(i) / kSteps;
      levels_[static_cast<std::size_t>(i)] =
          static_cast<float>(255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055));
    }
  }
  [[nodiscard]] float level(float light) const {
    const float place = std::clamp(light, 0.0F, 1.0F) * kSteps;
    const auto i = static_cast<std::size_t>(place);
    return levels_[i] + (place - static_cast<float>(i)) * (levels_[i + 1] - levels_[i]);
  }

 private:
  static constexpr int kSteps = 16384;
  std::array<float, kSteps + 2> levels_{};
};

/// Normal numbers for millions of pixels: drawn once, then picked four at a time.
class Noise {
 public:
  explicit Noise(Random& random) : random_(random) {
    for (float& value : values_) value = static_cast<float>(random.normal());
  }
  float next() {
    if (left_ == 0) {
      bits_ = random_.below(std::uint64_t{1} << 60);
      left_ = 4;
    }
    const float value = values_[bits_ % kCount];
    bits_ /= kCount;
    --left_;
    return value;
  }

 private:
  static constexpr std::size_t kCount = 32768;
  Random& random_;
  std::array<float, kCount> values_{};
  std::uint64_t bits_ = 0;
  int left_ = 0;
};

}  // namespace

ColorPicture paint_photo(const PaintedPhoto& photo) {
  constexpr float kFull = 1.5F;  // a sensor is full at some point
  static const Gamma gamma;
  Random random(photo.seed);
  Light light = bare_tissue(photo, random);
  for (const PaintedLine& line : photo.lines) paint(light, photo, line);
  lay_on_sheet(light, photo);
  shade(light, photo);
  add_glare(light, photo, random);
  for (float& value : light.values) value = std::min(value, kFull);
  blur(light, photo.blur_px);
  ColorPicture picture{photo.width, photo.height, {}};
  picture.rgb.resize(light.values.size());
  Noise noise(random);
  const auto deviation = static_cast<float>(photo.noise);
  for (std::size_t i = 0; i < light.values.size(); ++i) {
    const float seen = gamma.level(light.values[i]) + deviation * noise.next();
    picture.rgb[i] = static_cast<std::uint8_t>(std::clamp(seen, 0.0F, 254.4F) + 0.5F);
  }
  return picture;
}

}  // namespace incise::testing
