#include "support/contour_shapes.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/evaluation/level_loop.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

using units::kPi;

TEST(LevelLoop, FollowsACircleCounterClockwise) {
  const auto field = [](const Vec2& p) { return p.norm() - 5.0; };
  const LevelLoop loop = trace_level_loop(field, Vec2(1, 1), 8.0, 0.25);
  EXPECT_FALSE(loop.undefined_at.has_value());
  Contour contour;
  for (const Vec2& p : loop.points) {
    EXPECT_NEAR(p.norm(), 5.0, 1e-12);
    contour.points.emplace_back(p.x(), p.y(), 0.0);
  }
  EXPECT_NEAR(signed_area_mm2(contour, kDown), kPi * 25.0, 0.1);
  EXPECT_FALSE(crosses_itself_in_view(contour, kDown));
}

TEST(LevelLoop, TakesTheOutermostBorder) {
  const auto ring = [](const Vec2& p) { return std::abs(p.norm() - 5.0) - 1.0; };  // negative between radius 4 and 6
  const LevelLoop loop = trace_level_loop(ring, Vec2(5, 0), 3.0, 0.2);
  for (const Vec2& p : loop.points) EXPECT_NEAR(p.norm(), 6.0, 1e-12);
}

TEST(LevelLoop, SaysWhereTheFunctionEnds) {
  const auto half = [](const Vec2& p) {
    return p.y() > 3.0 ? std::numeric_limits<double>::quiet_NaN() : p.norm() - 5.0;
  };
  const LevelLoop loop = trace_level_loop(half, Vec2(0, 0), 8.0, 0.25);
  ASSERT_TRUE(loop.undefined_at.has_value());
  EXPECT_NEAR(loop.undefined_at->y(), 3.0, 0.5);
  EXPECT_GT(loop.undefined_at->x(), 3.0);
}

TEST(LevelLoop, NeedsAPointInsideAndABoundedRegion) {
  const auto field = [](const Vec2& p) { return p.norm() - 5.0; };
  EXPECT_THROW(static_cast<void>(trace_level_loop(field, Vec2(9, 0), 8.0, 0.25)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(trace_level_loop(field, Vec2(0, 0), 2.0, 0.25)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(trace_level_loop(field, Vec2(0, 0), 8.0, 0.0)), InvalidArgument);
}

TEST(OuterOffset, OfAConvexShapeObeysSteiner) {
  // Area of a convex body grown by d: A + d L + π d²; length L + 2 π d.
  const Contour square{.points = {{-5, -5, 2}, {5, -5, 2}, {5, 5, 2}, {-5, 5, 2}}, .is_closed = true};
  const Contour offset = outer_offset(square, 4.5, kDown);
  EXPECT_NEAR(signed_area_mm2(offset, kDown), 100.0 + 4.5 * 40.0 + kPi * 4.5 * 4.5, 0.05);
  EXPECT_NEAR(length_mm(offset), 40.0 + 2.0 * kPi * 4.5, 0.02);
  for (const Vec3& p : offset.points) EXPECT_NEAR(p.z(), 2.0, 1e-12);
}

TEST(OuterOffset, KeepsItsDistanceAndDoesNotCrossItselfRoundADeepDent) {
  const Contour edge = testing::kidney();
  const Contour offset = outer_offset(edge, 5.0, kDown);
  for (const Vec3& p : offset.points) EXPECT_NEAR(nearest_on(edge, p).distance_mm, 5.0, 1e-9);
  EXPECT_FALSE(crosses_itself_in_view(offset, kDown));
  for (const Vec3& p : edge.points) EXPECT_TRUE(contains_in_view(offset, p, kDown));
}

TEST(OuterOffset, LeavesOutThePocketThatAClosingMouthCutsOff) {
  // A thick C whose mouth is 4 mm wide: an offset by 5 mm closes it and must not leave a second loop inside.
  Contour c{.points = {}, .is_closed = true};
  const double mouth = 0.2;
  for (int i = 0; i <= 200; ++i) {
    const double a = mouth + (2.0 * kPi - 2.0 * mouth) * i / 200.0;
    c.points.emplace_back(14.0 * std::cos(a), 14.0 * std::sin(a), 0.0);
  }
  for (int i = 200; i >= 0; --i) {
    const double a = mouth + (2.0 * kPi - 2.0 * mouth) * i / 200.0;
    c.points.emplace_back(12.0 * std::cos(a), 12.0 * std::sin(a), 0.0);
  }
  const Contour offset = outer_offset(c, 5.0, kDown);
  for (const Vec3& p : offset.points) EXPECT_GT(p.norm(), 15.0);
  EXPECT_NEAR(signed_area_mm2(offset, kDown), kPi * 19.0 * 19.0, 12.0);
}

TEST(OuterOffset, TurnsWithItsInput) {
  const Contour edge = testing::irregular_tumor();
  const double angle = 0.6;
  const Contour a = testing::moved(outer_offset(edge, 5.0, kDown), angle, 1.0, Vec3(3, 4, 0));
  const Contour b = outer_offset(testing::moved(edge, angle, 1.0, Vec3(3, 4, 0)), 5.0, kDown);
  EXPECT_NEAR(signed_area_mm2(a, kDown), signed_area_mm2(b, kDown), 0.02);
  for (const Vec3& p : a.points) EXPECT_NEAR(nearest_on(b, p).distance_mm, 0.0, 0.01);
}

}  // namespace
}  // namespace incise
