#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/forecast_skill.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

TEST(RocCurve, CountsPairsAndHalvesForEqualScores) {
  // Events at 0.8 and 0.4, none at 0.1, 0.4, 0.6: pairs won 3 + 1, one equal: 4.5 of 6.
  const std::vector<Forecast> forecasts{{0.8, true}, {0.4, true}, {0.1, false}, {0.4, false}, {0.6, false}};
  const RocCurve curve = roc_curve(forecasts);
  EXPECT_EQ(curve.happened, 2u);
  EXPECT_EQ(curve.did_not, 3u);
  EXPECT_DOUBLE_EQ(curve.area, 4.5 / 6.0);
  ASSERT_EQ(curve.points.size(), 5u);  // 0.8, 0.6, 0.4, 0.1 and the corner
  EXPECT_DOUBLE_EQ(curve.points[1].caught, 0.5);
  EXPECT_DOUBLE_EQ(curve.points[1].false_alarms, 0.0);
  EXPECT_DOUBLE_EQ(curve.points.back().caught, 1.0);
  EXPECT_DOUBLE_EQ(curve.points.back().false_alarms, 1.0);
  double under = 0.0;  // trapezoids
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    under += 0.5 * (curve.points[i].caught + curve.points[i - 1].caught) *
             (curve.points[i].false_alarms - curve.points[i - 1].false_alarms);
  }
  EXPECT_NEAR(under, curve.area, 1e-12);
}

TEST(RocCurve, OneForAScoreThatTellsAndHalfForOneThatDoesNot) {
  EXPECT_DOUBLE_EQ(roc_curve(std::vector<Forecast>{{2.0, true}, {1.0, false}, {3.0, true}}).area, 1.0);
  EXPECT_DOUBLE_EQ(roc_curve(std::vector<Forecast>{{1.0, true}, {1.0, false}, {1.0, false}}).area, 0.5);
  EXPECT_DOUBLE_EQ(roc_curve(std::vector<Forecast>{{0.0, true}, {1.0, false}}).area, 0.0);
}

TEST(RocCurve, ItsIntervalHoldsTheTrueAreaAboutAsOftenAsItSays) {
  // Scores normal, the events' one standard deviation higher: area Φ(1/√2) = 0.7602.
  Random random(11);
  int held = 0;
  double width = 0.0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Forecast> forecasts;
    for (int i = 0; i < 40; ++i) forecasts.push_back({random.normal() + (i < 20 ? 1.0 : 0.0), i < 20});
    const RocCurve curve = roc_curve(forecasts, {.replicates = 499, .seed = 3});
    held += curve.confidence.low <= 0.7602 && curve.confidence.high >= 0.7602 ? 1 : 0;
    width += (curve.confidence.high - curve.confidence.low) / kTrials;
  }
  EXPECT_GE(held, 178);  // 95 % of 200, less four standard errors: percentile intervals are a little too narrow
  // Hanley and McNeil's standard error of this area with 20 of each kind is 0.077.
  EXPECT_NEAR(width, 2.0 * 1.96 * 0.077, 0.04) << "one that holds everything tells nothing";
}

TEST(RocCurve, IsLessSureOfForecastsThatComeInClusters) {
  // Events score higher by one in half of the clusters, by nothing in the others.
  Random random(5);
  std::vector<Forecast> forecasts;
  for (std::size_t cluster = 0; cluster < 8; ++cluster)
    for (int i = 0; i < 40; ++i)
      forecasts.push_back({random.normal() + (i < 20 && cluster % 2 == 0 ? 3.0 : 0.0), i < 20, cluster});
  const RocCurve clustered = roc_curve(forecasts);
  for (Forecast& forecast : forecasts) forecast.cluster = 0;
  const RocCurve independent = roc_curve(forecasts);
  EXPECT_EQ(clustered.area, independent.area);
  const auto width = [](const Interval& interval) { return interval.high - interval.low; };
  EXPECT_GT(width(clustered.confidence), 1.5 * width(independent.confidence));
  EXPECT_LT(clustered.confidence.low, clustered.area);
  EXPECT_GT(clustered.confidence.high, clustered.area);
}

TEST(RocCurve, HasAnIntervalWhereSomeClustersHoldOneKindAlone) {
  const std::vector<Forecast> forecasts{{0.8, true, 0}, {0.7, true, 0}, {0.2, false, 1}, {0.9, false, 1}};
  const RocCurve curve = roc_curve(forecasts);  // each replicate with both kinds holds all four
  EXPECT_EQ(curve.confidence.low, curve.area);
  EXPECT_EQ(curve.confidence.high, curve.area);
}

TEST(RocCurve, RefusesWhatHasNoArea) {
  EXPECT_THROW(static_cast<void>(roc_curve({})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(roc_curve(std::vector<Forecast>{{0.1, true}, {0.2, true}})), InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(roc_curve(std::vector<Forecast>{{nan, true}, {0.2, false}})), InvalidArgument);
}

TEST(IsSecondWorse, AnOpenRingIsWorseThanAnyClosedOneAndTwoTellNothing) {
  EXPECT_EQ(is_second_worse(1.0, 1.2), true);
  EXPECT_EQ(is_second_worse(1.2, 1.0), false);
  EXPECT_EQ(is_second_worse(1.0, 1.0), false);
  EXPECT_EQ(is_second_worse(3.0, std::nullopt), true);
  EXPECT_EQ(is_second_worse(std::nullopt, 3.0), false);
  EXPECT_EQ(is_second_worse(std::nullopt, std::nullopt), std::nullopt);
}

TEST(Reliability, CountsForecastsOfOneClusterForLessWhereTheyAreAlike) {
  std::vector<Forecast> alike, mixed;
  for (std::size_t i = 0; i < 60; ++i) {
    alike.push_back({0.5, i % 6 < 3, i % 6});       // all of a cluster, or none
    mixed.push_back({0.5, i / 6 % 2 == 0, i % 6});  // half of each
  }
  const auto interval = [](const std::vector<Forecast>& forecasts) {
    return reliability(forecasts, 1).bins.front().confidence;
  };
  // Wilson's interval of 30 of 60, and of half of 5, as the design effect is 12.
  EXPECT_NEAR(interval(mixed).low, 0.3774, 1e-4);
  EXPECT_NEAR(interval(alike).low, 0.1704, 1e-4);
  EXPECT_NEAR(interval(alike).low + interval(alike).high, 1.0, 1e-12);
}

TEST(Reliability, CountsByProbability) {
  const std::vector<Forecast> forecasts{{0.0, false}, {0.1, true}, {0.9, true}, {1.0, true}, {0.95, false}};
  const Reliability found = reliability(forecasts, 5);
  ASSERT_EQ(found.bins.size(), 2u);
  EXPECT_EQ(found.bins[0].forecasts, 2u);
  EXPECT_DOUBLE_EQ(found.bins[0].mean_said, 0.05);
  EXPECT_DOUBLE_EQ(found.bins[0].share, 0.5);
  EXPECT_EQ(found.bins[1].happened, 2u);
  EXPECT_NEAR(found.bins[1].share, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(found.brier_score, (0.0 + 0.81 + 0.01 + 0.0 + 0.9025) / 5.0, 1e-12);
}

TEST(Reliability, HasWilsonsInterval) {
  // 10 of 40, computed by hand from the formula: 0.1419 to 0.4019.
  std::vector<Forecast> forecasts(40, Forecast{0.3, false});
  for (std::size_t i = 0; i < 10; ++i) forecasts[i].happened = true;
  const Reliability found = reliability(forecasts, 1);
  EXPECT_NEAR(found.bins.at(0).confidence.low, 0.1419, 5e-4);
  EXPECT_NEAR(found.bins.at(0).confidence.high, 0.4019, 5e-4);
}

TEST(Reliability, RefusesWhatIsNoProbability) {
  EXPECT_THROW(static_cast<void>(reliability({})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(reliability(std::vector<Forecast>{{1.1, true}})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(reliability(std::vector<Forecast>{{0.5, true}}, 0)), InvalidArgument);
}

}  // namespace
}  // namespace incise
