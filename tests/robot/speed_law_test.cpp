#include "robot/speed_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

constexpr double kAcceleration = 100.0, kJerk = 2000.0;

/// Largest acceleration and jerk found by differences over short times.
struct Extremes {
  double speed = 0.0, acceleration = 0.0, jerk = 0.0;
};
Extremes extremes_of(const SpeedLaw& law) {
  Extremes found;
  const double h = 1e-4;
  for (double t = 0.0; t <= law.duration_s(); t += h) {
    const double before = law.speed_mm_s(t - h), now = law.speed_mm_s(t), after = law.speed_mm_s(t + h);
    found.speed = std::max(found.speed, now);
    found.acceleration = std::max(found.acceleration, std::abs(after - now) / h);
    found.jerk = std::max(found.jerk, std::abs(after - 2.0 * now + before) / (h * h));
  }
  return found;
}

TEST(SpeedLaw, KeepsSpeedAccelerationAndJerk) {
  const SpeedLaw law({{30.0, 7.0}, {10.0, 2.0}, {1.0, 9.0}, {20.0, 40.0}}, kAcceleration, kJerk);
  const Extremes found = extremes_of(law);
  EXPECT_NEAR(found.speed, 40.0, 20.0);  // 20 mm are enough for most of it
  EXPECT_LE(found.acceleration, kAcceleration * (1.0 + 1e-6));
  EXPECT_GT(found.acceleration, 0.95 * kAcceleration);
  EXPECT_LE(found.jerk, kJerk * (1.0 + 1e-3));
  EXPECT_EQ(law.speed_mm_s(0.0), 0.0);
  EXPECT_NEAR(law.speed_mm_s(law.duration_s() - 1e-9), 0.0, 1e-6);
}

TEST(SpeedLaw, RunsEachPieceAtItsSpeed) {
  const SpeedLaw law({{30.0, 7.0}, {10.0, 2.0}, {30.0, 5.0}}, kAcceleration, kJerk);
  EXPECT_NEAR(law.speed_mm_s(law.time_s(15.0)), 7.0, 1e-12);
  EXPECT_NEAR(law.speed_mm_s(law.time_s(30.0)), 2.0, 1e-6);  // slowed down before the slower piece begins
  EXPECT_NEAR(law.speed_mm_s(law.time_s(35.0)), 2.0, 1e-12);
  EXPECT_NEAR(law.speed_mm_s(law.time_s(55.0)), 5.0, 1e-12);
}

TEST(SpeedLaw, StaysBelowASpeedThatItHasNoRoomFor) {
  const SpeedLaw law({{1.0, 1000.0}}, kAcceleration, kJerk);
  const Extremes found = extremes_of(law);
  EXPECT_LE(found.acceleration, kAcceleration * (1.0 + 1e-6));
  EXPECT_LT(found.speed, 12.0);
  EXPECT_NEAR(law.arc_mm(law.duration_s() - 1e-9), 1.0, 1e-9);
}

TEST(SpeedLaw, TimeAndPlaceAreInverse) {
  const SpeedLaw law({{3.0, 7.0}, {0.02, 2.0}, {4.0, 5.0}}, kAcceleration, kJerk);
  for (double arc = 0.0; arc < 7.02; arc += 0.137) EXPECT_NEAR(law.arc_mm(law.time_s(arc)), arc, 1e-9);
  for (double t = 0.0, last = -1.0; t < law.duration_s(); t += 0.01) {
    EXPECT_GT(law.arc_mm(t), last);
    last = law.arc_mm(t);
  }
}

}  // namespace
}  // namespace incise::robot_detail
