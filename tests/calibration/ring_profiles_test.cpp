#include "calibration/sectors.hpp"

#include <incise/calibration/ring_profiles.hpp>
#include <incise/core/error.hpp>
#include <incise/core/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace incise {
namespace {

using testing::angle_of;
using testing::kSectors;

/// Specimens whose residual is a common function of the angle and, each by itself, noise of this size.
DragFit specimens_with(std::size_t count, const std::function<double(double)>& common, double own_mm) {
  Random random(5);
  DragFit fit;
  fit.residual = {
      .sd_mm = 0.3, .correlation_deg = 60.0, .reading_mm = 0.1, .specimen_spread_mm = 0.2, .placement_mm = 0.2};
  for (std::size_t s = 0; s < count; ++s) {
    SpecimenFit specimen{.name = std::to_string(s)};
    const double wave = own_mm * random.normal(), shift = own_mm * random.normal();
    for (std::size_t i = 0; i < kSectors; ++i) {
      const double a = angle_of(i);
      specimen.fitted_mm.push_back(-1.0 + 0.4 * std::cos(a));
      specimen.observed_mm.push_back(specimen.fitted_mm.back() + common(a) + wave * std::sin(3.0 * a) +
                                     shift * std::cos(a) + 0.05 * random.normal());
    }
    fit.specimens.push_back(std::move(specimen));
  }
  return fit;
}

double two_waves(double a) {
  return 0.4 * std::cos(2.0 * a + 0.3);
}

double rms_difference(const std::vector<double>& profile, const std::function<double(double)>& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < profile.size(); ++i) squares += std::pow(profile[i] - truth(angle_of(i)), 2);
  return std::sqrt(squares / static_cast<double>(profile.size()));
}

TEST(PhotographedProfile, IsTheMeanOverSpecimensAndItsSlowWaves) {
  DragFit fit = specimens_with(2, two_waves, 0.0);
  for (std::size_t i = 0; i < kSectors; ++i) {
    const double fast = i % 2 == 0 ? 0.2 : -0.2;
    fit.specimens[0].observed_mm[i] = -1.5 + fast;
    fit.specimens[1].observed_mm[i] = -0.5 + 0.6 * std::sin(angle_of(i));
  }
  const PhotographedProfile profile = photographed_profile(fit.specimens);
  EXPECT_NEAR(profile.constant_mm, -1.0, 1e-12);
  ASSERT_EQ(profile.mean_mm.size(), kSectors);
  for (std::size_t i = 0; i < kSectors; ++i) {
    EXPECT_NEAR(profile.mean_mm[i], -1.0 + 0.3 * std::sin(angle_of(i)) + (i % 2 == 0 ? 0.1 : -0.1), 1e-12);
    EXPECT_NEAR(profile.smoothed_mm[i], -1.0 + 0.3 * std::sin(angle_of(i)), 1e-12);
  }
}

TEST(PhotographedProfile, RefusesNoneAndProfilesOfDifferentLength) {
  EXPECT_THROW(static_cast<void>(photographed_profile({})), InvalidArgument);
  DragFit fit = specimens_with(2, two_waves, 0.0);
  fit.specimens[1].observed_mm.pop_back();
  EXPECT_THROW(static_cast<void>(photographed_profile(fit.specimens)), InvalidArgument);
}

TEST(ResidualProfile, OfManySpecimensIsWhatTheyHaveInCommon) {
  const ResidualProfile profile = residual_profile(specimens_with(24, two_waves, 0.2));
  EXPECT_LT(rms_difference(profile.mean_mm, two_waves), 0.08);
  EXPECT_LT(profile.sd_mm, 0.12);
  EXPECT_GT(profile.amplitude_mm, 0.1);
}

TEST(ResidualProfile, OfOneSpecimenBelievesLessOfItThanOfMany) {
  const auto share = [](std::size_t count) {
    const ResidualProfile profile = residual_profile(specimens_with(count, two_waves, 0.0));
    double along = 0.0;
    for (std::size_t i = 0; i < kSectors; ++i) along += profile.mean_mm[i] * two_waves(angle_of(i));
    return along / (0.5 * 0.4 * 0.4 * kSectors);
  };
  EXPECT_LT(share(1), 0.8);
  EXPECT_GT(share(1), 0.1);
  EXPECT_GT(share(4), share(1));
  EXPECT_GT(share(24), 0.85);
  EXPECT_GT(residual_profile(specimens_with(1, two_waves, 0.0)).sd_mm,
            residual_profile(specimens_with(24, two_waves, 0.0)).sd_mm);
}

TEST(ResidualProfile, OfSpecimensWithNothingInCommonIsNearZero) {
  const ResidualProfile profile = residual_profile(specimens_with(
      12, [](double) { return 0.0; }, 0.3));
  EXPECT_LT(rms_difference(profile.mean_mm, [](double) { return 0.0; }), 0.06);
}

/// Specimens whose simulated rings differ; of that, photographs show a share.
DragFit differing_specimens(std::size_t count, double share) {
  DragFit fit = specimens_with(
      count, [](double) { return 0.0; }, 0.0);
  Random random(9);
  for (SpecimenFit& specimen : fit.specimens) {
    const double mean = 0.4 * random.normal(), wave = 0.4 * random.normal();
    for (std::size_t i = 0; i < kSectors; ++i) {
      const double own = mean + wave * std::sin(2.0 * angle_of(i));
      specimen.fitted_mm[i] += own;
      specimen.observed_mm[i] += share * own;
    }
  }
  return fit;
}

TEST(ResidualProfile, FindsHowMuchOfSimulatedDifferencesPhotographsShow) {
  for (const double share : {0.0, 0.5, 1.0, 1.6}) {
    const DragFit fit = differing_specimens(24, share);
    const ResidualProfile profile = residual_profile(fit);
    EXPECT_NEAR(profile.simulated_share, share, 0.12 + 0.1 * std::abs(1.0 - share)) << "drawn towards 1";
    EXPECT_LT(profile.simulated_share_sd, 0.2);
    // What is expected of the calibration's own specimens lies near what was photographed.
    double worst = 0.0;
    for (const SpecimenFit& specimen : fit.specimens) {
      for (std::size_t i = 0; i < kSectors; ++i) {
        const double expected = profile.simulated_share * specimen.fitted_mm[i] + profile.mean_mm[i];
        worst = std::max(worst, std::abs(expected - specimen.observed_mm[i]));
      }
    }
    EXPECT_LT(worst, 0.35) << share;
  }
}

TEST(ResidualProfile, BelievesTheSimulationUntilPhotographsSayOtherwise) {
  const ResidualProfile one = residual_profile(differing_specimens(1, 0.0));
  EXPECT_NEAR(one.simulated_share, 1.0, 1e-9) << "one specimen differs from no other";
  EXPECT_NEAR(one.simulated_share_sd, 0.5, 1e-9);
}

TEST(ResidualProfile, RefusesAFitWithoutItsResidual) {
  DragFit fit = specimens_with(2, two_waves, 0.0);
  fit.residual = {};
  EXPECT_THROW(static_cast<void>(residual_profile(fit)), InvalidArgument);
}

}  // namespace
}  // namespace incise
