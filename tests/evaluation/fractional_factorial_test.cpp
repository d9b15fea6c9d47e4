#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/fractional_factorial.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace incise {
namespace {

TEST(FractionalFactorial, HasTheRunsThatItsFactorsNeed) {
  for (const auto& [factors, runs] : {std::pair(1, 2), std::pair(2, 4), std::pair(3, 8), std::pair(4, 8),
                                      std::pair(5, 16), std::pair(9, 32), std::pair(16, 32)})
    EXPECT_EQ(FractionalFactorial(static_cast<std::size_t>(factors)).runs(), static_cast<std::size_t>(runs)) << factors;
  EXPECT_THROW(FractionalFactorial(0), InvalidArgument);
  EXPECT_THROW(FractionalFactorial(17), InvalidArgument);
}

TEST(FractionalFactorial, IsBalancedAndOfResolutionFour) {
  for (const std::size_t factors : {4U, 8U, 16U}) {
    const FractionalFactorial design(factors);
    const auto sign = [&](std::size_t run, std::size_t k) { return design.is_on(run, k) ? 1 : -1; };
    for (std::size_t a = 0; a < factors; ++a) {
      int sum = 0;
      for (std::size_t run = 0; run < design.runs(); ++run) sum += sign(run, a);
      EXPECT_EQ(sum, 0);
      EXPECT_FALSE(design.is_on(0, a));
      for (std::size_t b = a + 1; b < factors; ++b) {
        int both = 0;
        for (std::size_t run = 0; run < design.runs(); ++run) both += sign(run, a) * sign(run, b);
        EXPECT_EQ(both, 0) << a << " and " << b;
        for (std::size_t c = b + 1; c < factors; ++c) {
          int three = 0;
          for (std::size_t run = 0; run < design.runs(); ++run) three += sign(run, a) * sign(run, b) * sign(run, c);
          EXPECT_EQ(three, 0) << a << ", " << b << " and " << c;
        }
      }
    }
  }
}

TEST(FractionalFactorial, NoTwoRunsAreTheSame) {
  for (std::size_t factors = 1; factors <= 16; ++factors) {
    const FractionalFactorial design(factors);
    std::set<std::vector<bool>> runs;
    for (std::size_t run = 0; run < design.runs(); ++run) {
      std::vector<bool> on;
      for (std::size_t k = 0; k < factors; ++k) on.push_back(design.is_on(run, k));
      runs.insert(on);
    }
    EXPECT_EQ(runs.size(), design.runs()) << factors;
  }
}

TEST(FractionalFactorial, GroupsPairsThatAreConfused) {
  const FractionalFactorial design(16);
  EXPECT_EQ(design.pair_groups().size(), 15U);
  std::size_t pairs = 0;
  for (const auto& group : design.pair_groups()) {
    pairs += group.size();
    for (const auto& pair : group) {
      std::size_t same = 0;
      for (std::size_t run = 0; run < design.runs(); ++run)
        same += design.is_alike(run, pair) == design.is_alike(run, group.front()) ? 1 : 0;
      EXPECT_EQ(same, design.runs());
    }
  }
  EXPECT_EQ(pairs, 120U);
}

using Responses = std::vector<std::optional<double>>;

/// 5, and 1 more for factor 2, 0.5 less for factor 9.
Responses known_responses(const FractionalFactorial& design, double noise) {
  Random random(3);
  Responses responses;
  for (std::size_t run = 0; run < design.runs(); ++run)
    responses.emplace_back(5.0 + (design.is_on(run, 2) ? 1.0 : 0.0) - (design.is_on(run, 9) ? 0.5 : 0.0) +
                           noise * random.normal());
  return responses;
}

TEST(FitFactorial, FindsEffectsThatAreKnownWhateverRunsAreMissing) {
  const FractionalFactorial design(16);
  Responses responses = known_responses(design, 0.0);
  for (const std::size_t run : {0U, 5U, 9U, 17U, 30U}) responses[run].reset();
  *responses[4] += 0.3;
  const auto disturbed = fit_factorial(design, responses);
  *responses[4] -= 0.3;
  const auto fit = fit_factorial(design, responses);
  ASSERT_TRUE(fit && disturbed);
  for (std::size_t k = 0; k < 16; ++k) {
    const double expected = k == 2 ? 1.0 : k == 9 ? -0.5 : 0.0;
    EXPECT_NEAR(fit->factors[k].change, expected, 1e-12) << k;
  }
  EXPECT_FALSE(fit->residuals[5]);
  EXPECT_NEAR(*fit->residuals[4], 0.0, 1e-12);
  EXPECT_GT(*disturbed->residuals[4], 0.05) << "what does not fit is left";
}

TEST(FitFactorial, StandardErrorsAreThoseOfTheNoise) {
  const FractionalFactorial design(16);
  const auto fit = fit_factorial(design, known_responses(design, 0.3));
  ASSERT_TRUE(fit);
  // Two means of 16 responses each: 0.3 sqrt(2 / 16).
  for (const FactorialEffect& effect : fit->factors) EXPECT_NEAR(effect.standard_error, 0.106, 0.04);
}

TEST(FitFactorial, SaysNothingOfTooLittle) {
  const FractionalFactorial design(16);
  Responses responses = known_responses(design, 0.1);
  Responses few = responses;
  for (std::size_t run = 0; run < 15; ++run) few[run].reset();
  EXPECT_FALSE(fit_factorial(design, few)) << "17 numbers of 17 responses";
  Responses never = responses;
  for (std::size_t run = 0; run < design.runs(); ++run)
    if (design.is_on(run, 4)) never[run].reset();
  EXPECT_FALSE(fit_factorial(design, never)) << "never seen with factor 4";
  responses.pop_back();
  EXPECT_THROW((void)fit_factorial(design, responses), InvalidArgument);
  responses.emplace_back(std::nan(""));
  EXPECT_THROW((void)fit_factorial(design, responses), InvalidArgument);
}

}  // namespace
}  // namespace incise
