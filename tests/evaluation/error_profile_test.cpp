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
  ProfileSettings settings{.start_direction = Vec3::UnitX()};
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
    ProfileSettings settings{.start_direction = Vec3::UnitX()};
    auto profile = error_profile(ring, testing::circle(10.0, 720), settings);
    ASSERT_TRUE(profile);
    EXPECT_EQ(std::max_element(profile->begin(), profile->end()) - profile->begin(), 9);
    settings.turn_deg = 90.0;
    profile = error_profile(ring, testing::circle(10.0, 720), settings);
    EXPECT_EQ(std::max_element(profile->begin(), profile->end()) - profile->begin(), 0);
    std::reverse(ring.points.begin(), ring.points.end());
  }
}

TEST(SectorMeans, AreThoseOfAnErrorProfileForItsValues) {
  const Contour ring = testing::circle(14.5, 3600, Vec3(1.0, 0.0, 0.0)), edge = testing::circle(10.0, 720);
  std::vector<double> errors;
  for (const Vec3& p : ring.points) errors.push_back(p.norm() - 10.0 - 4.5);
  ProfileSettings settings{.start_direction = Vec3::UnitX()};
  const auto means = sector_means(ring.points, errors, edge, settings);
  const auto profile = error_profile(ring, edge, settings);
  ASSERT_TRUE(means && profile);
  for (std::size_t k = 0; k < means->size(); ++k) EXPECT_NEAR(means->at(k), profile->at(k), 0.01) << k;
  settings.sectors = 1;
  EXPECT_NEAR(sector_means(ring.points, errors, edge, settings)->front(), 0.0, 0.05);
}

TEST(SectorMeans, AreAbsentWhereASectorIsEmptyAndNeedAValueForEachPlace) {
  const Points half{Vec3(14, 1, 0), Vec3(14, -1, 0)};
  EXPECT_FALSE(sector_means(half, std::vector{1.0, 2.0}, testing::circle(10.0, 720), {}));
  EXPECT_THROW(static_cast<void>(sector_means(half, std::vector{1.0}, testing::circle(10.0, 720), {})),
               InvalidArgument);
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
  ProfileSettings settings{.start_direction = Vec3::UnitZ()};
  EXPECT_THROW(static_cast<void>(error_profile(testing::circle(14.5, 360), testing::circle(10.0, 360), settings)),
               InvalidArgument);
}

TEST(ValuesAt, GiveASectorsValueInItsMiddleAndAreLinearBetween) {
  ProfileSettings settings{.start_direction = Vec3::UnitX()};
  const Contour edge = testing::circle(10.0, 720, Vec3(3.0, -2.0, 0.0));
  const auto at = [&](double degrees) {
    const double a = degrees * std::acos(-1.0) / 180.0;
    return Vec3(3.0 + 15.0 * std::cos(a), -2.0 + 15.0 * std::sin(a), 7.0);
  };
  const std::vector<double> values =
      values_at({1.0, 2.0, 4.0, 8.0}, {at(0.0), at(90.0), at(45.0), at(292.5)}, edge, settings);
  ASSERT_EQ(values.size(), 4U);
  EXPECT_NEAR(values[0], 1.0, 1e-9);
  EXPECT_NEAR(values[1], 2.0, 1e-9);
  EXPECT_NEAR(values[2], 1.5, 1e-9);
  EXPECT_NEAR(values[3], 0.75 * 8.0 + 0.25 * 1.0, 1e-9) << "round the ring, a quarter of a sector past the last middle";
  settings.turn_deg = 90.0;
  EXPECT_NEAR(values_at({1.0, 2.0, 4.0, 8.0}, {at(90.0)}, edge, settings)[0], 1.0, 1e-9);
}

TEST(ValuesAt, OfOneSectorAreTheSameEverywhere) {
  const std::vector<double> values = values_at({-0.7}, {Vec3(1, 5, 0), Vec3(-4, 0, 2)}, testing::circle(10.0, 360), {});
  EXPECT_DOUBLE_EQ(values.at(0), -0.7);
  EXPECT_DOUBLE_EQ(values.at(1), -0.7);
}

TEST(ValuesAt, GoBackToTheErrorsThatAProfileWasMadeOf) {
  const Contour ring = testing::circle(14.5, 720, Vec3(1.0, 0.5, 0.0)), edge = testing::circle(10.0, 720);
  const ProfileSettings settings{.turn_deg = 12.0};
  const std::vector<double> values = values_at(*error_profile(ring, edge, settings), ring.points, edge, settings);
  for (std::size_t i = 0; i < ring.points.size(); ++i) EXPECT_NEAR(values[i], ring.points[i].norm() - 14.5, 0.02) << i;
}

TEST(ValuesAt, NeedsAtLeastOneSectorAndAtMost360) {
  EXPECT_THROW(static_cast<void>(values_at({}, {}, testing::circle(10.0, 360), {})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(values_at(std::vector<double>(361), {}, testing::circle(10.0, 360), {})),
               InvalidArgument);
}

}  // namespace
}  // namespace incise
