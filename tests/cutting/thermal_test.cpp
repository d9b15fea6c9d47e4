#include <incise/core/error.hpp>
#include <incise/cutting/thermal.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const ThermalSettings kTissue;

/// T - T₀ of the moving line source, K, `ahead_mm` of it and `beside_mm` from its line.
double temperature_rise(double power_w, double speed_mm_s, double depth_mm, double ahead_mm, double beside_mm) {
  const double k = 1e-3 * kTissue.conductivity_w_m_k;
  const double rate = speed_mm_s / (2.0 * kTissue.diffusivity_mm2_s());
  const double scale = power_w * kTissue.absorbed_fraction / depth_mm / (2.0 * M_PI * k);
  return scale * std::exp(-rate * ahead_mm) * std::cyl_bessel_k(0.0, rate * std::hypot(ahead_mm, beside_mm));
}

/// The greatest rise at a lateral distance, by sampling along the line.
double sampled_peak(double power_w, double speed_mm_s, double depth_mm, double beside_mm) {
  double peak = 0.0;
  for (int i = 0; i <= 20000; ++i) {
    const double ahead = -beside_mm * 40.0 * i / 20000.0;
    peak = std::max(peak, temperature_rise(power_w, speed_mm_s, depth_mm, ahead, beside_mm));
  }
  return peak;
}

TEST(ThermalHalfWidth, IsWhereTheSampledPeakIsTheTemperatureOfDamage) {
  for (const double speed : {0.05, 0.3, 1.0}) {
    for (const double power : {0.05, 0.5, 2.0}) {
      const double half_width = thermal_half_width_mm(kTissue, power, speed, 5.0);
      EXPECT_NEAR(sampled_peak(power, speed, 5.0, half_width), kTissue.damage_c - kTissue.body_c, 0.01) << power << " W, " << speed << " mm/s";
    }
  }
}

TEST(ThermalHalfWidth, AtMuchPowerIsThatOfTheInstantPlaneSource) {
  const double capacity = 1e-3 * kTissue.heat_capacity_mj_m3_k;  // J/(mm³ K)
  const double rise = kTissue.damage_c - kTissue.body_c;
  const double limit = 35.0 / 5.0 / (std::sqrt(2.0 * M_PI * M_E) * capacity * 7.0 * rise);
  EXPECT_NEAR(thermal_half_width_mm(kTissue, 35.0, 7.0, 5.0) / limit, 1.0, 1e-3);
  EXPECT_NEAR(thermal_half_width_mm(kTissue, 3500.0, 7.0, 5.0) / (100.0 * limit), 1.0, 1e-7);
}

TEST(ThermalHalfWidth, GrowsWithoutBoundsAsTheSpeedFalls) {
  const double fast = thermal_half_width_mm(kTissue, 1.0, 7.0, 5.0);
  EXPECT_NEAR(thermal_half_width_mm(kTissue, 1.0, 7e-6, 5.0), 1e6 * fast, 1.0);
}

TEST(ThermalHalfWidth, GrowsWithPowerAndShrinksWithSpeedAndDepth) {
  double last = 0.0;
  for (const double power : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    const double half_width = thermal_half_width_mm(kTissue, power, 7.0, 5.0);
    EXPECT_GT(half_width, last);
    EXPECT_LT(thermal_half_width_mm(kTissue, power, 7.7, 5.0), half_width);
    EXPECT_LT(thermal_half_width_mm(kTissue, power, 7.0, 5.5), half_width);
    last = half_width;
  }
}

TEST(ThermalHalfWidth, IsSmoothWhereTheSeriesTakesOver) {
  // Powers for which the hottest place lies at R = 40, give or take 1 %.
  double last = 0.0;
  double last_step = 0.0;
  for (int i = -5; i <= 5; ++i) {
    const double half_width = thermal_half_width_mm(kTissue, 2.945 * (1.0 + 0.001 * i), 7.0, 5.0);
    if (last_step > 0.0) {
      EXPECT_NEAR((half_width - last) / last_step, 1.0, 2e-3);
    }
    if (last > 0.0) last_step = half_width - last;
    last = half_width;
  }
}

TEST(ThermalHalfWidth, OfNextToNoPowerIsZero) { EXPECT_EQ(thermal_half_width_mm(kTissue, 1e-9, 7.0, 5.0), 0.0); }

TEST(ThermalHalfWidth, ASpeedOfZeroIsRefused) {
  EXPECT_THROW(static_cast<void>(thermal_half_width_mm(kTissue, 35.0, 0.0, 5.0)), InvalidArgument);
}

TEST(ThermalHalfWidth, APowerThatIsNotFiniteIsRefused) {
  EXPECT_THROW(static_cast<void>(thermal_half_width_mm(kTissue, std::numeric_limits<double>::infinity(), 7.0, 5.0)), InvalidArgument);
}

TEST(ThermalSettings, EveryViolationIsListedWithItsField) {
  EXPECT_THAT(validate(kTissue), IsEmpty());
  ThermalSettings settings{.conductivity_w_m_k = 0.0, .damage_c = 37.0, .absorbed_fraction = 1.1};
  ThermalSettings lukewarm;
  lukewarm.damage_c = 37.0000001;  // "damaged" hundreds of kilometres away
  EXPECT_THAT(sentences(validate(lukewarm)), ElementsAre(HasSubstr("damage_c: found 37.0000001")));
  EXPECT_THAT(sentences(validate(settings)),
              ElementsAre(HasSubstr("conductivity_w_m_k: found 0"), HasSubstr("damage_c: found 37"),
                          HasSubstr("absorbed_fraction: found 1.1")));
}

}  // namespace
}  // namespace incise
