#include <incise/calibration/tissue_scenarios.hpp>
#include <incise/core/error.hpp>

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace incise {
namespace {

/// Eight samples with known moments: drag length 1.5 ± 0.1 mm, ln stiffness 0 ± 0.2, and a bias of 2 mm per mm of drag
/// length, -0.5 mm per unit of ln stiffness and 0.3 mm of its own.
std::vector<PosteriorSample> cube() {
  std::vector<PosteriorSample> samples;
  for (const double drag : {-0.1, 0.1}) {
    for (const double stiffness : {-0.2, 0.2}) {
      for (const double own : {-0.3, 0.3})
        samples.push_back({0.125, 1.5 + drag, std::exp(stiffness), 0.2 + 2.0 * drag - 0.5 * stiffness + own});
    }
  }
  // Two far ones that weigh nothing to speak of: the posterior does not end where the others do.
  samples.push_back({1e-12, 1.0, 1.0, 0.0});
  samples.push_back({1e-12, 2.0, 1.0, 0.0});
  return samples;
}

const ResidualEstimate kSpread{.specimen_spread_mm = 0.4};

TEST(TissueScenarios, HaveThePosteriorsMeanAndCovariance) {
  const TissueScenarios found = tissue_scenarios(cube(), kSpread, 0.15);
  ASSERT_EQ(found.points.size(), 5U);
  double weights = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const TissueScenario& s : found.points) {
    weights += s.weight;
    mean += s.weight * Eigen::Vector3d(s.drag_length_mm, std::log(s.stiffness_factor), s.bias_mm);
  }
  EXPECT_NEAR(weights, 1.0, 1e-12);
  EXPECT_NEAR(mean[0], 1.5, 1e-9);
  EXPECT_NEAR(mean[1], 0.0, 1e-9);
  EXPECT_NEAR(mean[2], 0.2, 1e-9);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const TissueScenario& s : found.points) {
    const Eigen::Vector3d off = Eigen::Vector3d(s.drag_length_mm, std::log(s.stiffness_factor), s.bias_mm) - mean;
    covariance += s.weight * off * off.transpose();
  }
  EXPECT_NEAR(covariance(0, 0), 0.01, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.04 + 0.15 * 0.15, 1e-9) << "the specimen's own stiffness is added";
  EXPECT_NEAR(covariance(0, 1), 0.0, 1e-9);
  // Points and what is left of the bias are together all of its variance.
  const double bias_variance = 4.0 * 0.01 + 0.25 * 0.04 + 0.09;
  EXPECT_NEAR(covariance(2, 2) + found.common_sd_mm * found.common_sd_mm, bias_variance + 0.16, 1e-9);
  EXPECT_NEAR(found.bias_sd_mm, std::sqrt(bias_variance + 0.16), 1e-9);
  EXPECT_NEAR(covariance(0, 2), 2.0 * 0.01, 1e-9) << "a longer drag length goes with its own bias";
}

TEST(TissueScenarios, DoNotGoBeyondTheDragLengthsOfThePosterior) {
  std::vector<PosteriorSample> samples = cube();
  samples.resize(8);  // it ends at 1.4 and 1.6 mm
  const TissueScenarios found = tissue_scenarios(samples, kSpread, 0.0);
  double least = 9.0, most = 0.0;
  for (const TissueScenario& s : found.points) {
    least = std::min(least, s.drag_length_mm);
    most = std::max(most, s.drag_length_mm);
  }
  EXPECT_EQ(least, 1.4);
  EXPECT_EQ(most, 1.6);
}

TEST(TissueScenarios, OneSampleIsOneTissueFiveTimes) {
  for (const TissueScenario& s : tissue_scenarios({{1.0, 1.5, 1.2, 0.1}}, kSpread, 0.0).points) {
    EXPECT_EQ(s.drag_length_mm, 1.5);
    EXPECT_NEAR(s.stiffness_factor, 1.2, 1e-5);
    EXPECT_NEAR(s.bias_mm, 0.1, 1e-9);
  }
}

TEST(TissueScenarios, RefuseWhatIsNoPosterior) {
  EXPECT_THROW(static_cast<void>(tissue_scenarios({}, kSpread, 0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(tissue_scenarios({{0.0, 1.5, 1.2, 0.1}}, kSpread, 0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(tissue_scenarios(cube(), kSpread, -0.1)), InvalidArgument);
}

}  // namespace
}  // namespace incise
