#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/cutting/thermal.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace incise {
namespace {

constexpr double kLeastRiseK = 5.0;        // above the body: towards 0 the half width grows without bound
constexpr double kLeastRadius = 1e-12;     // in units of 2 a / v
constexpr double kSeriesFrom = 40.0;       // from here the asymptotic series is exact to all digits, while K itself
                                           // approaches underflow
constexpr int kSeriesTerms = 20;
constexpr int kMaxDoublings = 1000;
constexpr int kMaxBisections = 200;

/// The functions of K₀ and K₁ at one radius that the hottest moment requires.
struct Bessel {
  double log_k0;  ///< logarithm of e^R K₀(R)
  double lead;    ///< 1 − K₀(R) / K₁(R), > 0
};

/// Asymptotic series of e^R √(2 R / π) K_n(R) = 1 + Σ a_j(n) / R^j, a_j(n) = Π_{i ≤ j} (4 n² − (2 i − 1)²) / (8 i)
/// (DLMF, 10.40.2).
Bessel bessel_far(double radius) {
  double zeroth = 1.0;
  double term0 = 1.0;
  double term1 = 1.0;
  double more = 0.0;  // series for K₁ minus series for K₀, summed without their leading 1
  for (int j = 1; j <= kSeriesTerms; ++j) {
    const double odd = (2.0 * j - 1.0) * (2.0 * j - 1.0);
    term0 *= -odd / (8.0 * j * radius);
    term1 *= (4.0 - odd) / (8.0 * j * radius);
    zeroth += term0;
    more += term1 - term0;
  }
  return {0.5 * std::log(std::numbers::pi / (2.0 * radius)) + std::log(zeroth), more / (zeroth + more)};
}

Bessel bessel(double radius) {
  if (radius >= kSeriesFrom) return bessel_far(radius);
  const double k0 = std::cyl_bessel_k(0.0, radius);
  return {std::log(k0) + radius, 1.0 - k0 / std::cyl_bessel_k(1.0, radius)};
}

/// Logarithm of exp(−x) K₀(R) where tissue is hottest: at −x = R K₀(R) / K₁(R) behind the source (lengths in units of
/// 2 a / v). Falls as R grows.
double log_peak(double radius) {
  const Bessel b = bessel(radius);
  return b.log_k0 - radius * b.lead;
}

/// The lateral distance for R: √(R² − x²).
double lateral(double radius) {
  const double lead = bessel(radius).lead;
  return radius * std::sqrt(lead * (2.0 - lead));
}

/// The R at which log_peak is `level`; nullopt: it lies below kLeastRadius.
std::optional<double> radius_of(double level) {
  double low = kLeastRadius;
  if (log_peak(low) <= level) return std::nullopt;
  double high = 1.0;
  for (int i = 0; log_peak(high) > level; ++i) {
    INCISE_REQUIRE(i < kMaxDoublings,
                   "expected a power, speed and depth for which some tissue stays below the "
                   "temperature of damage");
    high *= 2.0;
  }
  for (int i = 0; i < kMaxBisections && high > low * (1.0 + 1e-14); ++i) {
    const double middle = std::sqrt(low * high);
    (log_peak(middle) > level ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace

std::vector<Problem> validate(const ThermalSettings& s) {
  std::vector<Problem> violations = problems_of(s);
  if (violations.empty())
    Expect{violations}(s.damage_c >= s.body_c + kLeastRiseK, "damage_c", s.damage_c, "at least 5 K above body_c");
  return violations;
}

double thermal_half_width_mm(const ThermalSettings& settings, double power_w, double speed_mm_s, double depth_mm) {
  std::vector<Problem> violations = validate(settings);
  const Expect expect(violations);
  expect(power_w > 0.0, "power_w", power_w, "a power above 0 W");
  expect(speed_mm_s > 0.0, "speed_mm_s", speed_mm_s, "a speed above 0 mm/s");
  expect(depth_mm > 0.0, "depth_mm", depth_mm, "a depth above 0 mm");
  require_none(violations);
  constexpr double kWPerMm = 1e-3;  // of W/m
  const double line_w_mm = power_w * settings.absorbed_fraction / depth_mm;
  const double scale_k = line_w_mm / (2.0 * std::numbers::pi * settings.conductivity_w_m_k * kWPerMm);
  const std::optional<double> radius = radius_of(std::log((settings.damage_c - settings.body_c) / scale_k));
  return radius ? lateral(*radius) * 2.0 * settings.diffusivity_mm2_s() / speed_mm_s : 0.0;
}

}  // namespace incise
