#include <incise/calibration/stiffness_trend.hpp>
#include <incise/core/error.hpp>
#include <incise/core/random.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace incise {
namespace {

TEST(StiffnessTrend, OneSpecimenTellsNothingOfTheSlope) {
  const StiffnessTrend trend = stiffness_trend(std::vector<StiffnessReading>{{12.0, 0.4}}, 0.2);
  EXPECT_DOUBLE_EQ(trend.slope_mm, 0.0);
  EXPECT_DOUBLE_EQ(trend.slope_sd_mm, kTrendPriorMm);
  EXPECT_DOUBLE_EQ(trend.shift_sd_mm(12.0), 0.0);
  EXPECT_NEAR(trend.shift_sd_mm(48.0), 0.75 * kTrendPriorMm, 1e-12);
  EXPECT_NEAR(trend.shift_sd_mm(6.0), kTrendPriorMm, 1e-12) << "twice as soft, twice the yield";
}

TEST(StiffnessTrend, IsTheLineWhereReadingsAreExact) {
  // 6 mm kPa of drag, and 0.1 mm that has nothing to do with it.
  const std::vector<StiffnessReading> readings{
      {8.0, 0.1 - 6.0 / 8.0}, {12.0, 0.1 - 6.0 / 12.0}, {24.0, 0.1 - 6.0 / 24.0}};
  const StiffnessTrend trend = stiffness_trend(readings, 1e-4);
  EXPECT_NEAR(trend.reference_kpa, 12.0, 1e-9);
  EXPECT_NEAR(trend.slope_mm, 0.5, 1e-5);
  EXPECT_NEAR(trend.shift_mm(24.0), 0.25, 1e-5);
  EXPECT_NEAR(trend.shift_mm(6.0), -0.5, 1e-5);
  EXPECT_NEAR(trend.shift_mm(12.0), 0.0, 1e-9);
  EXPECT_NEAR(trend.shift_mm(1e9), trend.slope_mm, 1e-6) << "rigid tissue does not yield";
}

TEST(StiffnessTrend, TellsHowItsUncertaintyRisesWithStiffness) {
  const StiffnessTrend trend =
      stiffness_trend(std::vector<StiffnessReading>{{8.0, 0.0}, {12.0, 0.1}, {24.0, 0.2}}, 0.2);
  const double step = 1e-5;
  for (const double kpa : {15.0, 40.0}) {
    EXPECT_NEAR(trend.rise_sd_mm(kpa), (trend.shift_sd_mm(kpa * std::exp(step)) - trend.shift_sd_mm(kpa)) / step, 1e-4);
  }
}

TEST(StiffnessTrend, ItsIntervalHoldsTheTruthAsOftenAsItSays) {
  Random random(21);
  constexpr int kTrials = 2000;
  int within = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double drag_mm_kpa = 12.0 * kTrendPriorMm * random.normal();
    std::vector<StiffnessReading> readings;
    for (int s = 0; s < 12; ++s) {
      const double ln_kpa = std::log(12.0) + 0.2 * random.normal();
      readings.push_back({std::exp(ln_kpa), -drag_mm_kpa * std::exp(-ln_kpa) + 0.2 * random.normal()});
    }
    const StiffnessTrend trend = stiffness_trend(readings, 0.2);
    const double slope = drag_mm_kpa / trend.reference_kpa;
    within += std::abs(trend.slope_mm - slope) < 1.6449 * trend.slope_sd_mm ? 1 : 0;
  }
  EXPECT_NEAR(within / static_cast<double>(kTrials), 0.9, 0.03);  // four standard errors
}

TEST(StiffnessTrend, RefusesWhatIsNoReading) {
  EXPECT_THROW(static_cast<void>(stiffness_trend({}, 0.2)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(stiffness_trend(std::vector<StiffnessReading>{{0.0, 0.1}}, 0.2)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(stiffness_trend(std::vector<StiffnessReading>{{1.0, NAN}}, 0.2)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(stiffness_trend(std::vector<StiffnessReading>{{1.0, 0.1}}, 0.0)), InvalidArgument);
}

}  // namespace
}  // namespace incise
