#include <incise/core/error.hpp>
#include <incise/evaluation/statistics.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace incise {
namespace {

TEST(Summary, DividesTheSpreadByOneLessThanTheCount) {
  const std::vector<double> values{2, 4, 4, 4, 5, 5, 7, 9};  // mean 5, squares sum to 32
  const Summary summary = summarize(values);
  EXPECT_DOUBLE_EQ(summary.mean, 5.0);
  EXPECT_DOUBLE_EQ(summary.sd, std::sqrt(32.0 / 7.0));
  EXPECT_EQ(summary.min, 2.0);
  EXPECT_EQ(summary.max, 9.0);
}

TEST(Summary, KeepsTheDigitsOfASmallSpreadAboutALargeMean) {
  const std::vector<double> values{1e9 - 1.0, 1e9, 1e9 + 1.0};
  EXPECT_DOUBLE_EQ(summarize(values).sd, 1.0);
}

/// [NistStrd], univariate sets NumAcc1 to NumAcc4: 1001 values, and their certified mean and standard deviation.
TEST(Summary, HasTheCertifiedDigitsOfTheReferenceSets) {
  EXPECT_EQ(summarize(std::vector<double>{10000001, 10000003, 10000002}).mean, 10000002.0);
  EXPECT_EQ(summarize(std::vector<double>{10000001, 10000003, 10000002}).sd, 1.0);
  for (const double large : {1.0, 1e6, 1e7}) {
    std::vector<double> values{large + 0.2};
    for (int i = 0; i < 500; ++i) {
      values.push_back(large + 0.1);
      values.push_back(large + 0.3);
    }
    const Summary summary = summarize(values);
    EXPECT_NEAR(summary.mean / (large + 0.2), 1.0, 1e-14);
    // The data themselves are rounded to 1e-16 of `large`.
    EXPECT_NEAR(summary.sd, 0.1, std::max(1e-14, 1e-16 * large * 10.0));
  }
}

TEST(Summary, OfASingleValueHasNoSpread) {
  const std::vector<double> values{-3.0};
  const Summary summary = summarize(values);
  EXPECT_EQ(summary.sd, 0.0);
  EXPECT_EQ(summary.mean, -3.0);
}

TEST(Summary, RefusesNothingAndNumbersThatAreNone) {
  EXPECT_THROW(static_cast<void>(summarize({})), InvalidArgument);
  const std::vector<double> values{1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(static_cast<void>(summarize(values)), InvalidArgument);
}

}  // namespace
}  // namespace incise
