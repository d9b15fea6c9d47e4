#include <incise/core/error.hpp>
#include <incise/evaluation/clock.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace incise {
namespace {

TEST(ClockHours, GoClockwiseFromTheTopOfThePicture) {
  const Vec3 center(10, 20, 0);
  const Points points{center + Vec3(0, 5, 1), center + Vec3(5, 0, -1), center + Vec3(0, -2, 0),
                      center + Vec3(-1, 0, 0)};
  const auto hours = clock_hours(points, center, {0, 0, -1}, {0, 1, 0});
  EXPECT_NEAR(hours[0], 0.0, 1e-12);
  EXPECT_NEAR(hours[1], 3.0, 1e-12);
  EXPECT_NEAR(hours[2], 6.0, 1e-12);
  EXPECT_NEAR(hours[3], 9.0, 1e-12);
}

TEST(ClockHours, SeenFromBelowRunTheOtherWay) {
  EXPECT_NEAR(clock_hours({Vec3(5, 0, 0)}, Vec3::Zero(), {0, 0, 1}, {0, 1, 0})[0], 9.0, 1e-12);
}

TEST(ClockHours, TurnWithTwelveOClock) {
  EXPECT_NEAR(clock_hours({Vec3(5, 0, 0)}, Vec3::Zero(), {0, 0, -1}, {3, 0, 7})[0], 0.0, 1e-12);
  EXPECT_THROW(static_cast<void>(clock_hours({Vec3(5, 0, 0)}, Vec3::Zero(), {0, 0, -1}, {0, 0, 1})), InvalidArgument);
}

TEST(ErrorsByClock, GoToTheNearestHour) {
  const std::vector<double> hours{11.6, 0.4, 0.6, 6.0};
  const std::vector<double> errors{-1.0, 2.0, 5.0, 7.0};
  const auto sectors = errors_by_clock(hours, errors);
  EXPECT_EQ(sectors[11].hour, 12);
  EXPECT_EQ(sectors[11].points, 2U);
  EXPECT_EQ(sectors[11].mean_mm, 0.5);
  EXPECT_EQ(sectors[11].min_mm, -1.0);
  EXPECT_EQ(sectors[11].max_mm, 2.0);
  EXPECT_EQ(sectors[0].mean_mm, 5.0);
  EXPECT_EQ(sectors[5].points, 1U);
  EXPECT_FALSE(sectors[2].mean_mm || sectors[2].min_mm);
}

TEST(ErrorsByClock, RefusesPlacesOffTheFace) {
  EXPECT_THROW(static_cast<void>(errors_by_clock(std::vector<double>{12.0}, std::vector<double>{1.0})),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(errors_by_clock(std::vector<double>{1.0}, {})), InvalidArgument);
}

}  // namespace
}  // namespace incise
