#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/hausdorff.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

/// An arc of a circle, degrees; closed when it is the whole of it.
Contour arc(double radius, double from_deg, double to_deg, double height = 0.0) {
  Contour contour{.points = {}, .is_closed = to_deg - from_deg >= 360.0};
  const int steps = static_cast<int>(to_deg - from_deg) * 2;
  for (int k = 0; k < steps + (contour.is_closed ? 0 : 1); ++k) {
    const double angle = (from_deg + (to_deg - from_deg) * k / steps) * std::numbers::pi / 180.0;
    contour.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  return contour;
}

TEST(Hausdorff, OfConcentricRingsIsTheDifferenceOfTheirRadii) {
  const HausdorffDistance found = hausdorff_distance(arc(15, 0, 360), arc(13, 0, 360, 4.0), kDown, 0.1);
  EXPECT_NEAR(found.from_first_mm, 2.0, 1e-3);
  EXPECT_NEAR(found.from_second_mm, 2.0, 1e-3);  // the height does not count: it is a picture
}

TEST(Hausdorff, SeesAMissingArcFromOneSideOnly) {
  // What was cut lies on the ring; the middle of the missing 90 degrees is 2 R sin(22.5 deg) from either end.
  const HausdorffDistance found = hausdorff_distance(arc(15, 0, 270), arc(15, 0, 360), kDown, 0.1);
  EXPECT_NEAR(found.from_first_mm, 0.0, 1e-9);
  EXPECT_NEAR(found.from_second_mm, 30.0 * std::sin(std::numbers::pi / 8.0), 1e-3);
  EXPECT_EQ(found.symmetric_mm(), found.from_second_mm);
}

TEST(Hausdorff, ChangesSidesWithItsArguments) {
  const Contour a = arc(15, 0, 200);
  const Contour b = arc(12, 90, 450);
  const HausdorffDistance forth = hausdorff_distance(a, b, kDown, 0.2);
  const HausdorffDistance back = hausdorff_distance(b, a, kDown, 0.2);
  EXPECT_EQ(forth.from_first_mm, back.from_second_mm);
  EXPECT_EQ(forth.symmetric_mm(), back.symmetric_mm());
}

TEST(Hausdorff, RefusesAPoint) {
  EXPECT_THROW(static_cast<void>(hausdorff_distance({.points = {{0, 0, 0}}}, arc(5, 0, 360), kDown, 0.1)),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(hausdorff_distance(arc(5, 0, 360), arc(5, 0, 360), kDown, 0.0)), InvalidArgument);
}

}  // namespace
}  // namespace incise
