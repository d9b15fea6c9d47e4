#include <incise/core/error.hpp>
#include <incise/core/random.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace incise {
namespace {

constexpr int kDraws = 200000;

TEST(Random, UniformTakesTheTopBitsOfTheStandardEngine) {
  // The 10000th draw of a default-seeded mt19937_64 is fixed by the C++ standard: 9981545732273789042.
  Random random(5489);
  double last = 0.0;
  for (int i = 0; i < 10000; ++i) last = random.uniform();
  EXPECT_EQ(last, static_cast<double>(9981545732273789042ULL >> 11) / 9007199254740992.0);
}

TEST(Random, RepeatsItsSequenceForTheSameSeedOnly) {
  Random a(7);
  Random b(7);
  Random c(8);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const double x = a.normal();
    EXPECT_EQ(x, b.normal());
    differs = differs || x != c.normal();
  }
  EXPECT_TRUE(differs);
}

TEST(Random, UniformHasTheRightRangeMeanAndVariance) {
  Random random(1);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.uniform(2.0, 5.0);
    ASSERT_GE(x, 2.0);
    ASSERT_LT(x, 5.0);
    sum += x;
    squares += (x - 3.5) * (x - 3.5);
  }
  // Four standard errors: sqrt(0.75 / 200000) = 0.0019 for the mean, about as much for the variance.
  EXPECT_NEAR(sum / kDraws, 3.5, 0.008);
  EXPECT_NEAR(squares / kDraws, 0.75, 0.008);
}

TEST(Random, NormalHasTheRightMomentsAndTails) {
  Random random(2);
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    if (std::abs(x) > 2.0) ++beyond_two;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.009);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.013);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, 0.0455, 0.002);
}

TEST(Random, BelowIsEvenlySpreadAndStaysBelow) {
  Random random(3);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) {
    const std::uint64_t x = random.below(7);
    ASSERT_LT(x, 7U);
    ++counts[x];
  }
  for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
  EXPECT_THROW(random.below(0), InvalidArgument);
}

}  // namespace
}  // namespace incise
