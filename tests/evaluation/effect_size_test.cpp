#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/effect_size.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace incise {
namespace {

TEST(HedgesG, IsAsComputedByHand) {
  // Means 103 and 100, standard deviations 5.5 and 4.5, 50 in each group: s² = (5.5² + 4.5²)/2 = 25.25, d = 3/5.02494;
  // the usual approximation of the factor, 1 − 3/(4·98 − 1) = 0.99233, holds here to five digits.
  const auto effect = hedges_g({50, 100.0, 4.5}, {50, 103.0, 5.5});
  ASSERT_TRUE(effect.has_value());
  EXPECT_NEAR(effect->cohens_d, 0.5970, 5e-5);
  EXPECT_NEAR(effect->hedges_g, 0.5924, 5e-5);
  EXPECT_GT(effect->hedges_g, effect->confidence.low);
  EXPECT_LT(effect->hedges_g, effect->confidence.high);
}

TEST(HedgesG, HasTheExactFactorForFewSpecimens) {
  // Two and two: df = 2, and Γ(1) / Γ(1/2) = 1/√π.
  const auto effect = hedges_g({2, 0.0, 1.0}, {2, 1.0, 1.0});
  EXPECT_NEAR(effect->hedges_g / effect->cohens_d, 1.0 / std::sqrt(std::acos(-1.0)), 1e-12);
}

TEST(HedgesG, IntervalHoldsTheTrueEffectAsOftenAsItSays) {
  Random random(5);
  constexpr int kTrials = 300;
  constexpr double kTrue = 1.0;
  int held = 0;
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> before, after;
    for (int k = 0; k < 6; ++k) {
      before.push_back(random.normal());
      after.push_back(kTrue + random.normal());
    }
    const auto effect = hedges_g(moments_of(before), moments_of(after), 0.9);
    sum += effect->hedges_g;
    // The interval is of d, made smaller by the same factor as g.
    const double factor = effect->hedges_g / effect->cohens_d;
    if (effect->confidence.low <= factor * kTrue && factor * kTrue <= effect->confidence.high) ++held;
  }
  EXPECT_NEAR(static_cast<double>(held) / kTrials, 0.9, 0.05);  // 3 standard errors
  EXPECT_NEAR(sum / kTrials, kTrue, 0.12);                      // unbiased: d itself is 8 % too large
}

TEST(HedgesG, OfNothingThatSpreadsIsAbsent) {
  EXPECT_FALSE(hedges_g({5, 1.0, 0.0}, {5, 2.0, 0.0}).has_value());
  EXPECT_FALSE(hedges_g({1, 1.0, 0.0}, {2, 2.0, 1.0}).has_value());  // one degree of freedom
  EXPECT_FALSE(hedges_g_paired(std::vector<double>{1, 2}, std::vector<double>{2, 4}).has_value());
}

TEST(TTestPower, IsAsRPrintsIt) {
  // The examples in the manual of R's power.t.test [RCore]: n = 20, delta = 1, sd = 1; and n for a power of 0.90.
  EXPECT_NEAR(t_test_power(1.0, 20, TestDesign::Unpaired), 0.8689528, 5e-7);
  EXPECT_EQ(fewest_specimens(1.0, TestDesign::Unpaired, 0.90), 23U);  // 22.02110
  EXPECT_DOUBLE_EQ(t_test_power(0.0, 7, TestDesign::Unpaired, 0.05), 0.05);
  EXPECT_EQ(t_test_power(-1.0, 20, TestDesign::Unpaired), t_test_power(1.0, 20, TestDesign::Unpaired));
}

TEST(FewestSpecimens, AreThoseOfPrintedTables) {
  // Medium and large effect at alpha 0.05 and power 0.80: [Cohen1988], table 2.4.1; pairs: [Faul2007].
  EXPECT_EQ(fewest_specimens(0.5, TestDesign::Unpaired), 64U);
  EXPECT_EQ(fewest_specimens(0.8, TestDesign::Unpaired), 26U);
  EXPECT_EQ(fewest_specimens(0.5, TestDesign::Paired), 34U);
  EXPECT_EQ(fewest_specimens(0.8, TestDesign::Paired), 15U);           // 14.303, power.t.test
  EXPECT_EQ(fewest_specimens(1.0, TestDesign::Unpaired, 0.80), 17U);   // 16.715, power.t.test
  EXPECT_EQ(fewest_specimens(1.50, TestDesign::Paired, 0.95), 8U);     // [Lakens2013], its two worked examples
  EXPECT_EQ(fewest_specimens(1.13, TestDesign::Unpaired, 0.95), 22U);  // 44 in both groups
  EXPECT_FALSE(fewest_specimens(0.0, TestDesign::Paired).has_value());
  EXPECT_FALSE(fewest_specimens(1e-4, TestDesign::Paired).has_value());
  EXPECT_EQ(fewest_specimens(50.0, TestDesign::Unpaired), 2U);
}

TEST(FewestSpecimens, AreFoundUpToAMillion) {
  // (1.959964 + 0.841621)² / 0.003² + 1.959964² / 2 = 872 099.7; for an effect of 0.0028 it is 1 001 135.
  const auto n = fewest_specimens(0.003, TestDesign::Paired);
  ASSERT_TRUE(n.has_value());
  EXPECT_NEAR(static_cast<double>(*n), 872'100.0, 3.0);
  EXPECT_GE(t_test_power(0.003, *n, TestDesign::Paired), 0.8);
  EXPECT_LT(t_test_power(0.003, *n - 1, TestDesign::Paired), 0.8);
  EXPECT_FALSE(fewest_specimens(0.0028, TestDesign::Paired).has_value());
}

TEST(FewestSpecimens, RefusesAPowerThatChanceHasAlready) {
  EXPECT_THROW(static_cast<void>(fewest_specimens(1.0, TestDesign::Paired, 0.05, 0.05)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(t_test_power(1.0, 1, TestDesign::Paired)), InvalidArgument);
}

}  // namespace
}  // namespace incise
