#include <incise/calibration/incision_speed.hpp>
#include <incise/core/error.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

constexpr double kLineMm = 100.0;  // Paper II-B.1: three lines of 10 cm on each of two tongues

std::vector<TimedCut> cuts_at(const std::vector<double>& speeds) {
  std::vector<TimedCut> cuts;
  for (const double speed : speeds) cuts.push_back({kLineMm, kLineMm / speed});
  return cuts;
}

TEST(EstimateSpeed, OfThePapersSixCutsIsThePapersAndItsSpreadIsThatOfThePopulation) {
  const SpeedEstimate speed = estimate_speed(cuts_at({11.11, 6.66, 7.14, 7.14, 6.25, 5.00}));
  EXPECT_NEAR(speed.mean_mm_s, 7.22, 0.005);
  EXPECT_NEAR(speed.population_sd_mm_s, 1.89, 0.005);
  EXPECT_NEAR(speed.sample_sd_mm_s.value(), 2.07, 0.005);
  EXPECT_NEAR(speed.min_mm_s, 5.0, 1e-12);
  EXPECT_NEAR(speed.max_mm_s, 11.11, 1e-12);
  EXPECT_EQ(speed.recommended_mm_s, 7.0);
  EXPECT_EQ(speed.cuts, 6U);
}

TEST(EstimateSpeed, CountsEveryCutOnceHoweverLong) {
  const std::vector<TimedCut> cuts{{10.0, 1.0}, {1000.0, 500.0}};
  EXPECT_DOUBLE_EQ(estimate_speed(cuts).mean_mm_s, 6.0);
}

TEST(EstimateSpeed, OfOneCutHasNoSampleSd) {
  const SpeedEstimate speed = estimate_speed(cuts_at({4.4}));
  EXPECT_FALSE(speed.sample_sd_mm_s);
  EXPECT_EQ(speed.population_sd_mm_s, 0.0);
  EXPECT_EQ(speed.recommended_mm_s, 4.0);
}

TEST(EstimateSpeed, BelowOneMillimetreASecondIsRoundedToOneDigit) {
  EXPECT_NEAR(estimate_speed(cuts_at({0.334})).recommended_mm_s, 0.3, 1e-12);
  EXPECT_NEAR(estimate_speed(cuts_at({0.97})).recommended_mm_s, 1.0, 1e-12);
  EXPECT_EQ(estimate_speed(cuts_at({1.4})).recommended_mm_s, 1.0);
}

TEST(EstimateSpeed, RefusesWhatIsNoCut) {
  EXPECT_THROW((void)estimate_speed({}), InvalidArgument);
  for (const TimedCut& cut : {TimedCut{0.0, 1.0}, TimedCut{10.0, 0.0}, TimedCut{-1.0, 1.0},
                              TimedCut{10.0, std::numeric_limits<double>::quiet_NaN()},
                              TimedCut{std::numeric_limits<double>::infinity(), 1.0}}) {
    EXPECT_THROW((void)estimate_speed(std::vector<TimedCut>{{10.0, 1.0}, cut}), InvalidArgument);
  }
}

}  // namespace
}  // namespace incise
