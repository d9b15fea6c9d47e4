#include "support/contour_shapes.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/error_profile.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

TEST(ErrorProfile, OfConcentricCirclesIsTheSameAllRound) {
  const auto profile = error_profile(testing::circle(14.0, 360), testing::circle(10.0, 720), {});
  ASSERT_TRUE(profile);
  ASSERT_EQ(profile->size(), 36U);
  for (const double e : *profile) EXPECT_NEAR(e, 14.0 - 10.0 - 4.5, 0.002);
}

TEST(ErrorProfile, OfAShiftedRingIsGreatestWhereItWasShifted) {
  ProfileSettings settings;
  settings.start_direction = Vec3::UnitX();
  const auto profile =
      error_profile(testing::circle(14.5, 360, Vec3(1.0, 0.0, 0.0)), testing::circle(10.0, 720), settings);
  ASSERT_TRUE(profile);
  EXPECT_NEAR(profile->at(0), 1.0, 0.02);
  EXPECT_NEAR(profile->at(18), -1.0, 0.02);
  EXPECT_NEAR(profile->at(9), 0.0, 0.05);
}

TEST(ErrorProfile, RunsCounterClockwiseFromTheStartDirectionWhicheverWayTheContourRuns) {
  Contour ring = testing::circle(14.5, 360, Vec3(0.0, 1.0, 0.0));
  for (int way = 0; way < 2; ++way) {
    ProfileSettings settings;
    settings.start_direction = Vec3::UnitX();
    auto profile = error_profile(ring, testing::circle(10.0, 720), settings);
    ASSERT_TRUE(profile);
    EXPECT_EQ(std::max_element(profile->begin(), profile->end()) - profile->begin(), 9);
    settings.turn_deg = 90.0;
    profile = error_profile(ring, testing::circle(10.0, 720), settings);
    EXPECT_EQ(std::max_element(profile->begin(), profile->end()) - profile->begin(), 0);
    std::reverse(ring.points.begin(), ring.points.end());
  }
}

TEST(ErrorProfile, DoesNotSeeHeightsAlongTheCamerasAxis) {
  Contour ring = testing::circle(14.5, 360);
  for (Vec3& p : ring.points) p.z() = 3.0 + 0.2 * p.x();
  const auto profile = error_profile(ring, testing::circle(10.0, 720), {});
  ASSERT_TRUE(profile);
  for (const double e : *profile) EXPECT_NEAR(e, 0.0, 0.002);
}

TEST(ErrorProfile, OfARingBesideTheTumourIsAbsent) {
  EXPECT_FALSE(error_profile(testing::circle(5.0, 360, Vec3(30.0, 0.0, 0.0)), testing::circle(10.0, 360), {}));
}

TEST(ErrorProfile, RefusesAnOpenRingAndAStartAlongTheApproach) {
  Contour open = testing::circle(14.5, 360);
  open.is_closed = false;
  EXPECT_THROW(static_cast<void>(error_profile(open, testing::circle(10.0, 360), {})), InvalidArgument);
  ProfileSettings settings;
  settings.start_direction = Vec3::UnitZ();
  EXPECT_THROW(static_cast<void>(error_profile(testing::circle(14.5, 360), testing::circle(10.0, 360), settings)),
               InvalidArgument);
}

}  // namespace
}  // namespace incise
