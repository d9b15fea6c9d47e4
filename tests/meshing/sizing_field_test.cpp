#include "meshing/shapes.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/meshing/sizing_field.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::HasSubstr;

/// A square of 40 x 40 mm in the plane z = 0, cut downwards.
PlannedCut square_cut() {
  return {.path = {.points = {{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}}, .is_closed = true},
          .approach = {0, 0, -1},
          .depth_mm = 5.0};
}

PlannedCut straight_cut() {
  return {.path = {.points = {{-10, 0, 0}, {10, 0, 0}}, .is_closed = false}};
}

std::string message_of(const PlannedCut& cut, const SizingSettings& settings) {
  return testing::refusal_of<InvalidArgument>([&] { return SizingField::around_cut(cut, settings); });
}

TEST(SizingField, IsTheSameEverywhereWhenUniform) {
  const SizingField field = SizingField::uniform(1.5);
  EXPECT_DOUBLE_EQ(field.edge_length_mm(Vec3(0, 0, 0)), 1.5);
  EXPECT_DOUBLE_EQ(field.edge_length_mm(Vec3(1e3, -1e3, 5)), 1.5);
  EXPECT_FALSE(field.is_in_band(Vec3(0, 0, 0)));
}

TEST(DefaultLengths, FollowTheSizeOfASmallBody) {
  const SizingSettings usual;
  for (const double large_mm : {40.0, 100.0}) {
    EXPECT_EQ(default_lengths(large_mm).fine_mm, usual.fine_mm);
    EXPECT_EQ(default_lengths(large_mm).coarse_mm, usual.coarse_mm);
  }
  EXPECT_DOUBLE_EQ(default_lengths(9.0).fine_mm, 0.18);
  EXPECT_DOUBLE_EQ(default_lengths(9.0).coarse_mm, 0.9);
  EXPECT_EQ(default_lengths(9.0).growth, usual.growth);
}

TEST(SizingField, IsFineOnTheWallFromTheSurfaceToBelowTheTip) {
  const SizingField field = SizingField::around_cut(square_cut());
  for (const double z : {0.0, -3.0, -5.0, -6.4}) {
    EXPECT_DOUBLE_EQ(field.edge_length_mm(Vec3(20, 3, z)), 0.8) << z;
    EXPECT_TRUE(field.is_in_band(Vec3(20, 3, z))) << z;
  }
  EXPECT_FALSE(field.is_in_band(Vec3(20, 3, -6.6)));
}

TEST(SizingField, IsWiderTowardsTheInsideOfAClosedPath) {
  const SizingField field = SizingField::around_cut(square_cut());
  EXPECT_TRUE(field.is_in_band(Vec3(16.1, 0, -2)));
  EXPECT_FALSE(field.is_in_band(Vec3(15.9, 0, -2)));
  EXPECT_TRUE(field.is_in_band(Vec3(21.9, 0, -2)));
  EXPECT_FALSE(field.is_in_band(Vec3(22.1, 0, -2)));
}

TEST(SizingField, HasTheLargerWidthOnBothSidesOfAnOpenCutAndAroundItsEnds) {
  const SizingField field = SizingField::around_cut(straight_cut());
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(field.is_in_band(Vec3(0, side * 3.9, -2)));
    EXPECT_FALSE(field.is_in_band(Vec3(0, side * 4.1, -2)));
    EXPECT_TRUE(field.is_in_band(Vec3(side * 13.9, 0, -2)));
    EXPECT_FALSE(field.is_in_band(Vec3(side * 14.1, 0, -2)));
  }
}

TEST(SizingField, GrowsLinearlyWithTheDistanceUpToTheCoarseLength) {
  const SizingField field = SizingField::around_cut(square_cut());
  EXPECT_NEAR(field.edge_length_mm(Vec3(22 + 5, 0, -2)), 0.8 + 0.36 * 5, 1e-12);
  EXPECT_NEAR(field.edge_length_mm(Vec3(20, 0, -6.5 - 2)), 0.8 + 0.36 * 2, 1e-12);
  EXPECT_NEAR(field.distance_to_band_mm(Vec3(22 + 3, 0, -6.5 - 4)), 5.0, 1e-12);
  EXPECT_DOUBLE_EQ(field.edge_length_mm(Vec3(80, 0, 0)), 4.0);
}

TEST(SizingField, FollowsTheApproachDirectionAndTheDepthOfTheCut) {
  PlannedCut cut = square_cut();
  for (Vec3& p : cut.path.points) p = Vec3(p.z(), p.x(), p.y());  // now in the plane x = 0
  cut.approach = Vec3(-3, 0, 0);
  cut.depth_mm = 9.0;
  const SizingField field = SizingField::around_cut(cut);
  EXPECT_TRUE(field.is_in_band(Vec3(-10.4, 20, 3)));
  EXPECT_FALSE(field.is_in_band(Vec3(-10.6, 20, 3)));
}

TEST(SizingField, IsMeasuredFromTheHeightOfTheNearestPartOfThePath) {
  PlannedCut cut = straight_cut();
  cut.path.points[1].z() = 10.0;  // climbs half a millimetre per millimetre
  const SizingField field = SizingField::around_cut(cut);
  EXPECT_TRUE(field.is_in_band(Vec3(0, 0, 5.0 - 6.4)));
  EXPECT_FALSE(field.is_in_band(Vec3(0, 0, 5.0 - 6.6)));
}

TEST(SizingField, ScalesTheEdgeLengthsButNotTheBand) {
  const SizingField field = SizingField::around_cut(square_cut()).scaled(2.0);
  EXPECT_DOUBLE_EQ(field.edge_length_mm(Vec3(20, 0, 0)), 1.6);
  EXPECT_DOUBLE_EQ(field.edge_length_mm(Vec3(200, 0, 0)), 8.0);
  EXPECT_NEAR(field.edge_length_mm(Vec3(24, 0, 0)), 1.6 + 0.36 * 2, 1e-12);
}

TEST(SizingField, HardlyChangesWhenALongPathIsResampled) {
  const Vec3 half_axes(50, 30, 20);
  const SizingField few = SizingField::around_cut({.path = testing::ring_on_ellipsoid(half_axes, 15.0, 200)});
  const SizingField many = SizingField::around_cut({.path = testing::ring_on_ellipsoid(half_axes, 15.0, 5000)});
  for (const double x : {0.0, 5.0, 10.0, 18.0, 25.0}) {
    const Vec3 p(x, 0.3 * x, 12.0);
    EXPECT_NEAR(few.edge_length_mm(p), many.edge_length_mm(p), 0.01) << x;
  }
}

TEST(SizingField, NamesEveryViolationAtOnce) {
  const std::string message =
      message_of(straight_cut(), {.fine_mm = -1, .coarse_mm = 4, .growth = 0, .band_inside_mm = -2});
  EXPECT_THAT(message, HasSubstr("fine_mm: found -1"));
  EXPECT_THAT(message, HasSubstr("growth: found 0"));
  EXPECT_THAT(message, HasSubstr("band_inside_mm: found -2"));
}

TEST(SizingField, RefusesAFineLengthAboveTheCoarseOne) {
  EXPECT_THAT(message_of(straight_cut(), {.fine_mm = 5, .coarse_mm = 4}), HasSubstr("expected at most coarse_mm = 4"));
}

TEST(SizingField, RefusesCutsThatAreNoCuts) {
  EXPECT_THAT(message_of({.path = {.points = {{0, 0, 0}, {1, 0, 0}}, .is_closed = true}}, {}),
              HasSubstr("found 2 points, expected at least 3"));
  EXPECT_THAT(message_of({.path = {.points = {{1, 1, 1}, {1, 1, 1}}, .is_closed = false}}, {}), HasSubstr("length 0"));
  PlannedCut cut = square_cut();
  cut.path.points[2].y() = std::numeric_limits<double>::quiet_NaN();
  cut.approach = Vec3::Zero();
  cut.depth_mm = 0.0;
  const std::string message = message_of(cut, {});
  EXPECT_THAT(message, HasSubstr("path[2]: found a number that is not finite"));
  EXPECT_THAT(message, HasSubstr("approach"));
  EXPECT_THAT(message, HasSubstr("depth_mm: found 0"));
}

TEST(SizingField, RefusesNonPositiveUniformLengthsAndFactors) {
  EXPECT_THROW(static_cast<void>(SizingField::uniform(0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(SizingField::uniform(std::numeric_limits<double>::infinity())), InvalidArgument);
  EXPECT_THROW(static_cast<void>(SizingField::uniform(1.0).scaled(-1.0)), InvalidArgument);
}

}  // namespace
}  // namespace incise
