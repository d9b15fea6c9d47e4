#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/tongue_shape.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kTipThicknessMm = 4.0;  // the blunt part of the tip, above its waist
constexpr double kTipRound = 0.12;       // share of the length over which the tip is rounded
constexpr double kSoleTaper = 0.25;      // share of the length over which the underside descends to the platform
constexpr double kSolePressMm = 2.0;     // depth of the unflattened underside below the platform
constexpr double kSoleEdgeMm = 1.5;      // half width, in z, of the rounded edge of the flat underside
constexpr double kRootStart = 0.8;       // s where the root begins to round off

// 0 at v = 0, where it rises as the square root of v; 1 from v = 1 on, reached with two vanishing derivatives.
double rise(double v, double exponent) {
  return v >= 1.0 ? 1.0 : std::sqrt(std::max(0.0, 1.0 - std::pow(1.0 - v, exponent)));
}

// 1 up to kRootStart, then falls to 0 at s = 1 as the square root of the distance from there.
double root_end(double s) {
  if (s <= kRootStart) return 1.0;
  const double v = (s - kRootStart) / (1.0 - kRootStart);
  return std::sqrt(std::max(0.0, 1.0 - v * v * v * v));
}

double superellipse(double u, double p, double q) {
  return std::pow(std::max(0.0, 1.0 - std::pow(std::abs(u), p)), 1.0 / q);
}

// max(z, 0) with its edge replaced by a parabola of half width k; exact outside it.
double rounded_floor(double z, double k) {
  if (z >= k) return z;
  if (z <= -k) return 0.0;
  return (z + k) * (z + k) / (4.0 * k);
}

struct Station {
  double midline_x_mm, left_mm, right_mm;  // mid-line, and half widths on either side of it
  double up_mm, down_mm;                   // height above and depth below the waist, before relief and floor
};

double share_of_length(const TongueShape& shape, double y_mm) {
  return y_mm / shape.length_mm + 0.5;
}

double midline_at(const TongueShape& shape, double s) {
  const double along = 2.0 * s - 1.0;
  return shape.bend_mm * (along * along - 1.0 / 3.0);
}

Station station_at(const TongueShape& shape, double s) {
  const double end = root_end(s);
  const double half = 0.5 * shape.width_mm * rise(s / shape.outline_taper, 2.4) * end;
  const double back = std::pow(std::max(0.0, 1.0 - std::pow(std::max(0.0, 1.0 - s / shape.back_taper), 2.2)), 0.9);
  const double rest = shape.height_mm - shape.waist_mm - kTipThicknessMm;
  return {midline_at(shape, s), half * (1.0 + shape.asymmetry), half * (1.0 - shape.asymmetry),
          (kTipThicknessMm * rise(s / kTipRound, 2.4) + rest * back) * end,
          (shape.waist_mm + kSolePressMm) * rise(s / kSoleTaper, 2.4) * end};
}

double relief_mm(const TongueShape& shape, double x_mm, double y_mm) {
  double sum = 0.0;
  for (const SurfaceWave& wave : shape.relief)
    sum += wave.amplitude_mm * std::cos(wave.wave_per_mm.dot(Vec2(x_mm, y_mm)) + wave.phase);
  return sum;
}

TissueSpan span_in(const TongueShape& shape, const Station& station, double u, double x_mm, double y_mm) {
  // The relief fades with the height towards tip and root, so the outline stays closed.
  const double fade = station.up_mm / (shape.height_mm - shape.waist_mm);
  const double up = station.up_mm + relief_mm(shape, x_mm, y_mm) * fade;
  const double low = shape.waist_mm - station.down_mm * superellipse(u, 4.0, 2.5);
  return {rounded_floor(low, kSoleEdgeMm), shape.waist_mm + up * superellipse(u, 2.6, 2.2)};
}

}  // namespace

TongueShape draw_tongue_shape(const TongueShapeSettings& settings, Random& random) {
  require_none(problems_of(settings));
  TongueShape shape;
  const auto varied = [&](double mean) { return mean * (1.0 + settings.variation * random.uniform(-1.0, 1.0)); };
  shape.length_mm = varied(settings.length_mm);
  shape.width_mm = varied(settings.width_mm);
  shape.height_mm = varied(settings.height_mm);
  shape.waist_mm = random.uniform(8.0, 10.0);
  shape.back_taper = random.uniform(0.64, 0.76);
  shape.outline_taper = random.uniform(0.48, 0.58);
  shape.bend_mm = settings.bend_mm * random.uniform(-1.0, 1.0);
  shape.asymmetry = settings.asymmetry * random.uniform(-1.0, 1.0);
  double total = 0.0;
  for (SurfaceWave& wave : shape.relief) {
    const double length = random.uniform(28.0, 60.0);
    const double heading = random.uniform(0.0, 2.0 * units::kPi);
    wave.wave_per_mm = 2.0 * units::kPi / length * Vec2(std::cos(heading), std::sin(heading));
    wave.phase = random.uniform(0.0, 2.0 * units::kPi);
    wave.amplitude_mm = random.uniform(0.5, 1.5);
    total += wave.amplitude_mm;
  }
  for (SurfaceWave& wave : shape.relief) wave.amplitude_mm *= settings.bump_mm / total;
  return shape;
}

double midline_x_mm(const TongueShape& shape, double y_mm) {
  return midline_at(shape, share_of_length(shape, y_mm));
}

std::optional<TissueSpan> span_at(const TongueShape& shape, double x_mm, double y_mm) {
  const double s = share_of_length(shape, y_mm);
  if (!(s > 0.0 && s < 1.0)) return std::nullopt;
  const Station station = station_at(shape, s);
  const double off = x_mm - station.midline_x_mm;
  const double u = off / (off >= 0.0 ? station.left_mm : station.right_mm);
  if (!(std::abs(u) < 1.0)) return std::nullopt;
  return span_in(shape, station, u, x_mm, y_mm);
}

double volume_mm3(const TongueShape& shape, int steps) {
  INCISE_REQUIRE(steps >= 16 && steps <= 4096, fmt::format("expected steps in [16, 4096], found {}", steps));
  // s = (1 - cos t)/2 and u = sin f turn the vertical tangents at the outline into smooth integrands.
  double volume = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps * units::kPi;
    const double s = 0.5 * (1.0 - std::cos(t));
    const Station station = station_at(shape, s);
    const double y = (s - 0.5) * shape.length_mm;
    const double dy = 0.5 * std::sin(t) * units::kPi / steps * shape.length_mm;
    double area = 0.0;
    for (int j = -steps; j < steps; ++j) {
      const double f = (j + 0.5) / steps * 0.5 * units::kPi;
      const double half = j >= 0 ? station.left_mm : station.right_mm;
      const double u = std::sin(f);
      const TissueSpan span = span_in(shape, station, u, station.midline_x_mm + u * half, y);
      area += (span.high_mm - span.low_mm) * half * std::cos(f) * 0.5 * units::kPi / steps;
    }
    volume += area * dy;
  }
  return volume;
}

Box3 bounds_mm(const TongueShape& shape) {
  const double half = 0.5 * shape.width_mm * (1.0 + std::abs(shape.asymmetry)) + std::abs(shape.bend_mm);
  double relief = 0.0;
  for (const SurfaceWave& wave : shape.relief) relief += std::abs(wave.amplitude_mm);
  return {Vec3(-half, -0.5 * shape.length_mm, 0.0), Vec3(half, 0.5 * shape.length_mm, shape.height_mm + relief)};
}

}  // namespace incise
