#include <incise/calibration/tissue_scenarios.hpp>
#include <incise/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

const std::vector<PosteriorSample> kThreeToOne{{0.6, 1.0, 1.0, 0.1},
                                               {0.2, 2.0, std::exp(0.4), 0.5}};  // weights of 3 to 1

TEST(TissueScenarios, OfAMeasuredSpecimenThePosteriorsMeanIsTheOneTissue) {
  const std::vector<TissueScenario> found = tissue_scenarios(kThreeToOne, 0.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].weight, 1.0, 1e-12);
  EXPECT_NEAR(found[0].drag_length_mm, 1.25, 1e-12);
  EXPECT_NEAR(found[0].stiffness_factor, std::exp(0.1), 1e-12);
  EXPECT_NEAR(found[0].bias_mm, 0.2, 1e-12);
}

TEST(TissueScenarios, HaveTheSpreadOfAStiffnessThatIsNotKnown) {
  const std::vector<TissueScenario> found = tissue_scenarios(kThreeToOne, 0.5);
  ASSERT_EQ(found.size(), 3U);
  double weights = 0.0, mean = 0.0, variance = 0.0;
  for (const TissueScenario& s : found) {
    weights += s.weight;
    mean += s.weight * std::log(s.stiffness_factor);
    EXPECT_NEAR(s.drag_length_mm, 1.25, 1e-12);
  }
  for (const TissueScenario& s : found) variance += s.weight * std::pow(std::log(s.stiffness_factor) - mean, 2);
  EXPECT_NEAR(weights, 1.0, 1e-12);
  EXPECT_NEAR(mean, 0.1, 1e-12);
  EXPECT_NEAR(variance, 0.25, 1e-12);
}

TEST(TissueScenarios, RefuseWhatIsNoPosterior) {
  EXPECT_THROW(static_cast<void>(tissue_scenarios({}, 0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(tissue_scenarios({{0.0, 1.5, 1.2, 0.1}}, 0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(tissue_scenarios(kThreeToOne, -0.1)), InvalidArgument);
}

}  // namespace
}  // namespace incise
