#include "support/contour_shapes.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/contour_errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

Contour square(double half) {
  return {.points = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, .is_closed = true};
}

TEST(ContourErrors, AreDistancesToSegmentsNotToCorners) {
  // 5 mm beside the middle of a side that is 20 mm long: the corners are 11.2 mm away.
  const Contour cut{.points = {{15, -1, 0}, {15, 1, 0}}, .is_closed = false};
  const ContourErrors errors = contour_errors(cut, square(10.0), 5.0, kDown);
  for (const double error : errors.signed_error_mm) EXPECT_NEAR(error, 0.0, 1e-12);
}

TEST(ContourErrors, OfARingAreTheDifferenceOfItsRadii) {
  const Contour edge = testing::circle(10.0, 3600);
  const ContourErrors errors = contour_errors(testing::circle(14.0, 3600), edge, 5.0, kDown);
  for (const double error : errors.signed_error_mm) EXPECT_NEAR(error, -1.0, 1e-5);
  EXPECT_EQ(errors.points.points.size(), 352U);  // 2π · 14 mm / 0.25 mm = 351.86
}

TEST(ContourErrors, GoOnFallingInsideTheTumour) {
  const ContourErrors errors = contour_errors(testing::circle(7.0, 720), testing::circle(10.0, 720), 5.0, kDown);
  for (std::size_t i = 0; i < errors.signed_error_mm.size(); ++i) {
    EXPECT_NEAR(errors.signed_distance_mm[i], -3.0, 1e-3);
    EXPECT_NEAR(errors.signed_error_mm[i], -8.0, 1e-3);
  }
}

TEST(ContourErrors, AreMeasuredInSpace) {
  // The cut lies 3 mm beside and 4 mm below the edge's side.
  const Contour cut{.points = {{13, -1, -4}, {13, 1, -4}}, .is_closed = false};
  EXPECT_NEAR(contour_errors(cut, square(10.0), 4.5, kDown).signed_error_mm[0], 0.5, 1e-12);
}

TEST(ContourErrors, DoNotChangeWithAMotionOfBothContoursAndTheView) {
  const Contour edge = testing::irregular_tumor();
  const Contour cut = testing::circle(13.0, 300, Vec3(0.5, -1.0, 1.0));
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto move = [&](Contour contour) {
    for (Vec3& p : contour.points) p = turn * p + Vec3(40, -20, 7);
    return contour;
  };
  const ContourErrors here = contour_errors(cut, edge, 5.0, kDown);
  const ContourErrors there = contour_errors(move(cut), move(edge), 5.0, turn * kDown);
  EXPECT_THAT(there.signed_error_mm, ::testing::Pointwise(::testing::DoubleNear(1e-10), here.signed_error_mm));
}

TEST(ContourErrors, RefuseWhatIsNoContour) {
  const Contour edge = testing::circle(10.0, 60);
  Contour broken = edge;
  broken.points[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(contour_errors(broken, edge, 5.0, kDown)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(contour_errors(edge, broken, 5.0, kDown)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(contour_errors(edge, {.points = {}, .is_closed = true}, 5.0, kDown)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(contour_errors(edge, edge, -1.0, kDown)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(contour_errors(edge, edge, 5.0, kDown, 0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(contour_errors(edge, edge, 5.0, kDown, 1e-9)), InvalidArgument);
}

TEST(ResampleByStep, FitsAWholeNumberOfSteps) {
  const Contour line{.points = {{0, 0, 0}, {1.1, 0, 0}}, .is_closed = false};
  const Contour even = resample_by_step(line, 0.25);  // 4.4 steps -> 4 of 0.275 mm
  ASSERT_EQ(even.points.size(), 5U);
  EXPECT_NEAR(even.points[1].x(), 0.275, 1e-12);
}

}  // namespace
}  // namespace incise
