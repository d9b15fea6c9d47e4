#include <incise/core/error.hpp>
#include <incise/evaluation/registration_score.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(RegistrationScore, WeighsMeanAndGreatestError) {
  EXPECT_DOUBLE_EQ(registration_score_mm(1.6, 3.3), 2.025);
  EXPECT_THROW(static_cast<void>(registration_score_mm(2.0, 1.0)), InvalidArgument);
}

TEST(RegistrationPercent, IsAShareOfTheBaselineAndZeroForAFailure) {
  EXPECT_DOUBLE_EQ(registration_percent(2.025, 2.025), 100.0);
  EXPECT_DOUBLE_EQ(registration_percent(1.0, 2.0), 50.0);
  EXPECT_EQ(registration_percent(std::nullopt, 2.0), 0.0);
  EXPECT_THROW(static_cast<void>(registration_percent(1.0, 0.0)), InvalidArgument);
}

TEST(BaselineRange, HoldsTheBaselineThatARowWasMadeWith) {
  const PrintedScore row{.mean_mm = {1.6, 0.05}, .max_mm = {3.3, 0.05}, .percent = {103.6, 0.05}};
  const BaselineRange range = baseline_range(row);
  EXPECT_NEAR(range.low_mm, 1.905, 1e-3);
  EXPECT_NEAR(range.high_mm, 2.004, 1e-3);
}

}  // namespace
}  // namespace incise
