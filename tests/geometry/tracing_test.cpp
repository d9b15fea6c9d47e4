#include "geometry/pictures.hpp"
#include "support/contour_shapes.hpp"
#include "support/directions.hpp"

#include <incise/core/random.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/geometry/tracing.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace incise {
namespace {

using testing::circle;
using testing::drawn;

TEST(LongestPath, RunsThroughAForkByItsLongestBranches) {
  const std::optional<Contour> path =
      longest_path(drawn({"..........", ".#...#....", "..#..#....", "...#######", "..........", "#........."}));
  ASSERT_TRUE(path);
  EXPECT_FALSE(path->is_closed);
  EXPECT_EQ(path->points.front(), Vec3(1, 1, 0));
  EXPECT_EQ(path->points.back(), Vec3(9, 3, 0));
  EXPECT_EQ(path->points.size(), 9U);
  EXPECT_FALSE(longest_path(drawn({"...", ".#.", "..."})));
}

TEST(LevelLines, PassWhereLinearInterpolationSaysSo) {
  ScalarRaster raster(RasterGrid{Vec2(10, 20), 2.0, 3, 3}, 0.0);
  raster.at(1, 1) = 1.0;
  const std::vector<Contour> lines = level_lines(raster, 0.25);
  ASSERT_EQ(lines.size(), 1U);
  ASSERT_EQ(lines[0].points.size(), 4U);
  for (const Vec3& p : lines[0].points) EXPECT_NEAR((p - Vec3(12, 22, 0)).norm(), 1.5, 1e-12);
  EXPECT_GT(signed_area_mm2(lines[0], kDown), 0.0) << "counter-clockwise round a blob";
}

TEST(LevelLines, GoRoundAHoleTheOtherWay) {
  const std::vector<Contour> lines = level_lines(blurred(drawn({"###", "#.#", "###"}), 0.0), 0.5);
  ASSERT_EQ(lines.size(), 2U) << "the picture's frame closes the outer line";
  EXPECT_GT(signed_area_mm2(lines[0], kDown), 0.0);
  EXPECT_LT(signed_area_mm2(lines[1], kDown), 0.0);
}

TEST(LevelLines, DecideASaddleByItsMiddle) {
  ScalarRaster raster(RasterGrid{Vec2::Zero(), 1.0, 2, 2}, 0.0);
  raster.pixels = {1.0, 0.0, 0.0, 1.0};
  EXPECT_EQ(level_lines(raster, 0.4).size(), 1U);
  EXPECT_EQ(level_lines(raster, 0.6).size(), 2U);
}

TEST(LevelLines, EndAtTheBorderWhereNothingIsKnownBeyondIt) {
  ScalarRaster raster(RasterGrid{Vec2::Zero(), 1.0, 2, 2}, 0.0);
  raster.pixels = {1.0, 0.0, 1.0, 0.0};
  const std::vector<Contour> lines = level_lines_inside(raster, 0.25);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_FALSE(lines[0].is_closed);
  EXPECT_EQ(lines[0].points, (Points{Vec3(0.75, 0, 0), Vec3(0.75, 1, 0)}));
}

TEST(LevelLines, MeasureABlurredDiscToAHundredthOfAPixel) {
  Raster raster(grid_around({-6, -6}, {6, 6}, 0.1, 1.0), 0);
  testing::stamp_disc(raster, {0.02, 0.03}, 5.0);
  const std::vector<Contour> lines = level_lines(blurred(raster, 0.2), 0.5);
  ASSERT_EQ(lines.size(), 1U);
  // The half level of a blurred disc lies sigma²/(2R) = 0.004 mm further in.
  EXPECT_NEAR(signed_area_mm2(lines[0], kDown), std::numbers::pi * 4.996 * 4.996, 0.1);
}

TEST(LevelLines, AreClosedAndSimpleForAnyPicture) {
  Random random(15);
  ScalarRaster raster(RasterGrid{Vec2::Zero(), 1.0, 20, 20}, 0.0);
  for (double& value : raster.pixels) value = random.uniform();
  for (const Contour& line : level_lines(raster, 0.5)) {
    ASSERT_GE(line.points.size(), 4U);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      EXPECT_LE((line.points[(i + 1) % line.points.size()] - line.points[i]).norm(), std::numbers::sqrt2);
    }
    EXPECT_FALSE(crosses_itself_in_view(line, kDown));
  }
  EXPECT_THROW((void)level_lines(raster, 0.5, 0.5), InvalidArgument);
}

TEST(Smoothed, HardlyShrinksACircle) {
  const Contour result = smoothed(circle(10.0, 400), 1.0);
  for (const Vec3& p : result.points) EXPECT_NEAR(p.norm(), 10.0 - 1.0 / 4000.0, 2e-5);
}

TEST(Smoothed, EvensOutNoiseAndKeepsTheEndsOfAnOpenCurve) {
  Random random(16);
  Contour line{.points = {}, .is_closed = false};
  for (int i = 0; i <= 200; ++i) line.points.emplace_back(0.1 * i, 0.0, 0.0);
  const Contour straight = smoothed(line, 0.7);
  for (std::size_t i = 0; i < line.points.size(); ++i) EXPECT_LT((straight.points[i] - line.points[i]).norm(), 1e-9);
  for (Vec3& p : line.points) p.y() = 0.02 * random.normal();
  const Contour result = smoothed(line, 0.7);
  EXPECT_LT((result.points.front() - line.points.front()).norm(), 1e-9);
  EXPECT_LT((result.points.back() - line.points.back()).norm(), 1e-9);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 30; i < 170; ++i) {
    before += line.points[i].y() * line.points[i].y();
    after += result.points[i].y() * result.points[i].y();
  }
  EXPECT_LT(after, 0.25 * before);
  EXPECT_EQ(smoothed(line, 0.0).points, line.points);
}

TEST(Smoothed, OfATinyCircleIsItsMiddle) {
  const Contour result = smoothed(circle(1e-9, 40), 1.0);  // six thousand million points would be a millimetre
  for (const Vec3& p : result.points) EXPECT_LT(p.norm(), 1e-12);
}

}  // namespace
}  // namespace incise
