#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/geometry/contour.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

constexpr double kRounding = 1e-12;

Contour square(double side, double height = 0.0) {
  return {{{0, 0, height}, {side, 0, height}, {side, side, height}, {0, side, height}}, true};
}

Contour random_star(Random& random, std::size_t count) {
  Contour contour;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double radius = random.uniform(5.0, 15.0);
    contour.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), random.uniform(-1.0, 1.0));
  }
  return contour;
}

Mat3 random_rotation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized().matrix();
}

TEST(Length, CountsTheClosingSegmentOfAClosedContourOnly) {
  Contour contour = square(3.0);
  EXPECT_DOUBLE_EQ(length_mm(contour), 12.0);
  contour.is_closed = false;
  EXPECT_DOUBLE_EQ(length_mm(contour), 9.0);
  EXPECT_DOUBLE_EQ(length_mm(Contour{}), 0.0);
}

TEST(Resample, SpacesPointsEvenlyRoundASquare) {
  const Contour result = resample(square(2.0), 8);
  const Points expected{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  ASSERT_EQ(result.points.size(), 8U);
  EXPECT_TRUE(result.is_closed);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_LT((result.points[i] - expected[i]).norm(), kRounding) << i;
}

TEST(Resample, KeepsBothEndsOfAnOpenContour) {
  const Contour result = resample({{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}, false}, 4);
  const Points expected{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((result.points[i] - expected[i]).norm(), kRounding) << i;
}

TEST(Resample, PassesRepeatedPoints) {
  const Contour result = resample({{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 0, 0}}, false}, 3);
  EXPECT_LT((result.points[1] - Vec3(1, 0, 0)).norm(), kRounding);
}

TEST(Resample, LeavesPointsOnTheContourAndHardlyShortensIt) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const Contour star = random_star(random, 40);
    const Contour result = resample(star, 4000);
    for (const Vec3& p : result.points) ASSERT_LT(nearest_on(star, p).distance_mm, 1e-9);
    EXPECT_NEAR(length_mm(result), length_mm(star), 0.01 * length_mm(star));
    EXPECT_LE(length_mm(result), length_mm(star) + 1e-9);
  }
}

TEST(Resample, RefusesWhatHasNoLength) {
  EXPECT_THROW((void)resample({{{1, 1, 1}, {1, 1, 1}}, true}, 5), InvalidArgument);
  EXPECT_THROW((void)resample({{{1, 1, 1}}, true}, 5), InvalidArgument);
  EXPECT_THROW((void)resample(square(1.0), 2), InvalidArgument);
  EXPECT_THROW((void)resample({{{0, 0, 0}, {NAN, 0, 0}}, false}, 3), InvalidArgument);
}

TEST(NearestOn, FindsFootPointsOnSegmentsAndCorners) {
  const ContourPoint on_side = nearest_on(square(2.0), {1.5, -3.0, 0.0});
  EXPECT_LT((on_side.position_mm - Vec3(1.5, 0, 0)).norm(), kRounding);
  EXPECT_DOUBLE_EQ(on_side.distance_mm, 3.0);
  EXPECT_EQ(on_side.segment, 0U);
  EXPECT_DOUBLE_EQ(on_side.fraction, 0.75);
  EXPECT_DOUBLE_EQ(nearest_on(square(2.0), {5, 6, 0}).distance_mm, 5.0);
  EXPECT_EQ(nearest_on(square(2.0), {-1, 1, 0}).segment, 3U) << "the closing segment";
}

TEST(NearestOn, TakesOnePointAsThatPoint) {
  EXPECT_DOUBLE_EQ(nearest_on({{{0, 3, 4}}, true}, Vec3::Zero()).distance_mm, 5.0);
  EXPECT_THROW((void)nearest_on(Contour{}, Vec3::Zero()), InvalidArgument);
}

TEST(ViewAlong, IsTheWorldFrameWhenLookingDown) {
  const ViewFrame view = view_along({0, 0, -2});
  EXPECT_LT((view.x - Vec3::UnitX()).norm(), kRounding);
  EXPECT_LT((view.y - Vec3::UnitY()).norm(), kRounding);
  EXPECT_LT((view.z - Vec3::UnitZ()).norm(), kRounding);
}

TEST(ViewAlong, IsRightHandedAndInvertibleForEveryApproach) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 approach(random.normal(), random.normal(), random.normal());
    const ViewFrame view = view_along(trial < 3 ? Vec3(Vec3::Unit(trial)) : approach);
    EXPECT_LT((view.x.cross(view.y) - view.z).norm(), kRounding);
    EXPECT_NEAR(view.x.norm(), 1.0, kRounding);
    const Vec3 p(random.normal(), random.normal(), random.normal());
    EXPECT_LT((view.from_view(view.to_view(p)) - p).norm(), 1e-11);
  }
  EXPECT_THROW((void)view_along(Vec3::Zero()), InvalidArgument);
}

TEST(SignedArea, IsPositiveCounterClockwiseAgainstTheApproach) {
  EXPECT_DOUBLE_EQ(signed_area_mm2(square(3.0), kDown), 9.0);
  EXPECT_DOUBLE_EQ(signed_area_mm2(square(3.0), -kDown), -9.0);
}

TEST(CounterClockwise, ReversesButKeepsTheFirstPoint) {
  Contour clockwise = square(1.0);
  std::swap(clockwise.points[1], clockwise.points[3]);
  const Contour result = counter_clockwise(clockwise, kDown);
  EXPECT_GT(signed_area_mm2(result, kDown), 0.0);
  EXPECT_EQ(result.points[0], clockwise.points[0]);
  EXPECT_EQ(counter_clockwise(result, kDown).points, result.points);
}

TEST(StartFarthestAlong, RotatesTheOrder) {
  const Contour result = start_farthest_along(square(1.0), {1, 2, 0});
  EXPECT_EQ(result.points, (Points{{1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}}));
  EXPECT_THROW((void)start_farthest_along({{{0, 0, 0}}, false}, {1, 0, 0}), InvalidArgument);
}

TEST(ContainsInView, IgnoresTheHeightOfThePoint) {
  EXPECT_TRUE(contains_in_view(square(2.0), {1, 1, 50}, kDown));
  EXPECT_FALSE(contains_in_view(square(2.0), {3, 1, 0}, kDown));
  EXPECT_FALSE(contains_in_view(Contour{}, {3, 1, 0}, kDown));
}

TEST(CrossesItself, TellsAnEightFromASquare) {
  EXPECT_FALSE(crosses_itself_in_view(square(1.0), kDown));
  EXPECT_TRUE(crosses_itself_in_view({{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, true}, kDown));
  EXPECT_FALSE(
      crosses_itself_in_view({{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, true}, kDown))
      << "repeated points are no crossing";
  EXPECT_TRUE(crosses_itself_in_view({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, -1, 0}}, false}, kDown));
}

TEST(CurveCentroid, IsNotMovedByUnevenSampling) {
  Contour contour = square(2.0);
  contour.points.insert(contour.points.begin() + 1, {{0.1, 0, 0}, {0.2, 0, 0}, {0.3, 0, 0}});
  EXPECT_LT((curve_centroid(contour) - Vec3(1, 1, 0)).norm(), kRounding);
}

TEST(Contours, MoveWithARigidMotion) {
  Random random(21);
  for (int trial = 0; trial < 20; ++trial) {
    const Contour star = random_star(random, 30);
    const Mat3 rotation = random_rotation(random);
    const Vec3 shift(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
    Contour moved = star;
    for (Vec3& p : moved.points) p = rotation * p + shift;
    EXPECT_NEAR(length_mm(moved), length_mm(star), 1e-9);
    EXPECT_NEAR(signed_area_mm2(moved, rotation * kDown), signed_area_mm2(star, kDown), 1e-7);
    EXPECT_LT((curve_centroid(moved) - rotation * curve_centroid(star) - shift).norm(), 1e-9);
    EXPECT_FALSE(crosses_itself_in_view(moved, rotation * kDown));
    const Vec3 p(random.uniform(-20, 20), random.uniform(-20, 20), 0.0);
    EXPECT_EQ(contains_in_view(moved, rotation * p + shift, rotation * kDown), contains_in_view(star, p, kDown));
    EXPECT_NEAR(nearest_on(moved, rotation * p + shift).distance_mm, nearest_on(star, p).distance_mm, 1e-9);
  }
}

}  // namespace
}  // namespace incise
