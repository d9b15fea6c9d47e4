#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/block_bootstrap.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace incise {
namespace {

/// A stationary series whose neighbours correlate by `rho`; a long run-in makes it forget its start.
ContourValues correlated(std::size_t n, double rho, double mean, Random& random, bool is_ring = false) {
  ContourValues series{.values = {}, .is_ring = is_ring};
  double state = 0.0;
  for (std::size_t i = 0; i < n + 200; ++i) {
    state = rho * state + std::sqrt(1.0 - rho * rho) * random.normal();
    if (i >= 200) series.values.push_back(mean + state);
  }
  return series;
}

TEST(ContourCorrelation, OfIndependentPointsLeavesAllOfThem) {
  Random random(1);
  const ContourCorrelation found = contour_correlation(correlated(2000, 0.0, 0.0, random));
  EXPECT_LE(found.block, 3U);
  EXPECT_NEAR(found.n_effective.value() / 2000.0, 1.0, 0.2);
}

TEST(ContourCorrelation, OfCorrelatedPointsCountsTheirWorth) {
  // n (1 − ρ) / (1 + ρ) independent values: 222 for ρ = 0.8.
  Random random(2);
  const ContourCorrelation found = contour_correlation(correlated(2000, 0.8, 0.0, random));
  EXPECT_GT(found.block, 8U);
  EXPECT_NEAR(found.n_effective.value(), 222.0, 80.0);
}

TEST(ContourCorrelation, OfAWaveRoundTheRingIsWorthAFewPoints) {
  ContourValues ring;
  for (int i = 0; i < 360; ++i) ring.values.push_back(std::cos(i * std::numbers::pi / 180.0));
  const ContourCorrelation found = contour_correlation(ring);
  EXPECT_GE(found.block, 50U);  // nearly as long as allowed, 3 √360 = 57
  EXPECT_LT(found.n_effective.value(), 10.0);
}

TEST(ContourCorrelation, DoesNotDependOnWhereARingStarts) {
  Random random(3);
  ContourValues ring = correlated(300, 0.7, 1.0, random, true);
  const ContourCorrelation before = contour_correlation(ring);
  std::rotate(ring.values.begin(), ring.values.begin() + 77, ring.values.end());
  const ContourCorrelation after = contour_correlation(ring);
  EXPECT_EQ(before.block, after.block);
  EXPECT_NEAR(before.standard_error, after.standard_error, 1e-12);
}

TEST(BlockBootstrap, KeepsItsLevelWhereTheTestByPointDoesNot) {
  // No difference at all, but correlated points: how often does each test claim one at 0.05?
  Random random(4);
  constexpr int kTrials = 120;
  int pooled = 0;
  int blocks = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<ContourValues> before{correlated(300, 0.9, 0.0, random)};
    const std::vector<ContourValues> after{correlated(300, 0.9, 0.0, random)};
    if (*student_t_test(moments_of(before[0].values), moments_of(after[0].values)).p < 0.05) ++pooled;
    const BootstrapSettings settings{.replicates = 399, .seed = static_cast<std::uint64_t>(trial)};
    if (*block_bootstrap_test(before, after, settings).p < 0.05) ++blocks;
  }
  EXPECT_GT(pooled, kTrials / 2);  // √19 times too sure: two out of three
  EXPECT_LT(blocks, kTrials / 5);
}

TEST(BlockBootstrap, AgreesWithWelchOnIndependentPoints) {
  Random random(6);
  const std::vector<ContourValues> before{correlated(400, 0.0, 1.7, random), correlated(300, 0.0, 1.7, random)};
  const std::vector<ContourValues> after{correlated(500, 0.0, 1.55, random)};
  std::vector<double> pooled = before[0].values;
  pooled.insert(pooled.end(), before[1].values.begin(), before[1].values.end());
  const TTest welch = welch_t_test(moments_of(pooled), moments_of(after[0].values));
  const BootstrapTest test = block_bootstrap_test(before, after, {.replicates = 4999, .seed = 1});
  EXPECT_DOUBLE_EQ(test.difference, welch.difference);
  EXPECT_NEAR(test.standard_error.value() / *welch.standard_error, 1.0, 0.12);
  EXPECT_NEAR(test.confidence->low, welch.confidence->low, 0.02);
  EXPECT_NEAR(test.confidence->high, welch.confidence->high, 0.02);
}

TEST(BlockBootstrap, RepeatsItselfBitForBitWithItsSeed) {
  Random random(7);
  const std::vector<ContourValues> before{correlated(100, 0.5, 1.0, random)};
  const std::vector<ContourValues> after{correlated(101, 0.5, 1.1, random)};
  const auto run = [&](std::uint64_t seed) {
    return block_bootstrap_test(before, after, {.replicates = 499, .seed = seed});
  };
  EXPECT_EQ(run(3).confidence->low, run(3).confidence->low);
  EXPECT_NE(run(3).confidence->low, run(4).confidence->low);
}

TEST(BlockBootstrap, OfContoursWithoutSpreadSaysSo) {
  const std::vector<ContourValues> one{{.values = std::vector<double>(10, 1.5)}};
  const BootstrapTest test = block_bootstrap_test(one, one);
  EXPECT_EQ(test.verdict, TestVerdict::NoSpread);
  EXPECT_FALSE(test.p || test.confidence);
}

TEST(BlockBootstrap, RefusesTooFewPointsAndReplicates) {
  const std::vector<ContourValues> good{{.values = {1, 2, 3}}};
  const std::vector<ContourValues> few{{.values = {1, 2}}};
  EXPECT_THROW(static_cast<void>(block_bootstrap_test(few, good)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(block_bootstrap_test(good, {})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(block_bootstrap_test(good, good, {.replicates = 10})), InvalidArgument);
}

}  // namespace
}  // namespace incise
