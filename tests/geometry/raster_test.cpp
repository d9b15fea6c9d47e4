#include "geometry/pictures.hpp"

#include <incise/core/random.hpp>
#include <incise/geometry/raster.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

using testing::as_text;
using Rows = std::vector<std::string>;

VertexId v(std::size_t i) {
  return VertexId{i};
}

TEST(GridAround, CoversTheBoxAndItsBorderWithPixelCentres) {
  const RasterGrid grid = grid_around({1, 2}, {3, 5}, 0.5, 1.0);
  EXPECT_LT((grid.centre(0, 0) - Vec2(0, 1)).norm(), 1e-12);
  EXPECT_GE(grid.centre(grid.width - 1, 0).x(), 4.0);
  EXPECT_GE(grid.centre(0, grid.height - 1).y(), 6.0);
  EXPECT_LT((grid.index_of({1, 2}) - Vec2(2, 2)).norm(), 1e-12);
}

TEST(GridAround, RefusesNonsense) {
  EXPECT_THROW((void)grid_around({1, 2}, {0, 5}, 0.5, 1.0), InvalidArgument);
  EXPECT_THROW((void)grid_around({0, 0}, {1, 1}, 0.0, 1.0), InvalidArgument);
  EXPECT_THROW((void)grid_around({0, 0}, {1, NAN}, 0.5, 1.0), InvalidArgument);
  EXPECT_THROW((void)grid_around({0, 0}, {1e6, 1e6}, 0.1, 1.0), InvalidArgument);
}

TEST(StampDisc, SetsTheCentresWithinTheRadius) {
  Raster raster(RasterGrid{Vec2::Zero(), 1.0, 5, 5}, 0);
  stamp_disc(raster, {2, 2}, 1.5);
  EXPECT_EQ(as_text(raster), (Rows{".....", ".###.", ".###.", ".###.", "....."}));
  stamp_disc(raster, {-1, 0}, 1.0);  // reaches over the picture's edge
  EXPECT_EQ(raster.at(0, 0), 1);
  EXPECT_EQ(raster.at(0, 1), 0);
}

TEST(StampDisc, HasTheAreaOfADisc) {
  Raster raster(grid_around({-10, -10}, {10, 10}, 0.05, 0.0), 0);
  stamp_disc(raster, {0.3, -0.2}, 8.0);
  EXPECT_NEAR(area_mm2(raster), std::numbers::pi * 64.0, 0.3);
}

TEST(StampTriangle, SetsCentresWithinAndOnTheBorderWhicheverWayItTurns) {
  Raster raster(RasterGrid{Vec2::Zero(), 1.0, 4, 4}, 0);
  stamp_triangle(raster, {0, 0}, {3, 0}, {0, 3});
  EXPECT_EQ(as_text(raster), (Rows{"####", "###.", "##..", "#..."}));
  Raster turned(RasterGrid{Vec2::Zero(), 1.0, 4, 4}, 0);
  stamp_triangle(turned, {0, 0}, {0, 3}, {3, 0});
  EXPECT_EQ(turned.pixels, raster.pixels);
}

TEST(StampTriangle, LeavesNoCrackBetweenNeighbours) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    Raster raster(grid_around({-2, -2}, {2, 2}, 0.1, 0.0), 0);
    const Vec2 middle(random.uniform(-1, 1), random.uniform(-1, 1));
    const std::vector<Vec2> square{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    for (std::size_t i = 0; i < 4; ++i) stamp_triangle(raster, middle, square[i], square[(i + 1) % 4]);
    for (const std::uint8_t pixel : raster.pixels) ASSERT_EQ(pixel, 1);
  }
}

TEST(Sample, InterpolatesBetweenPixelCentres) {
  ScalarRaster raster(RasterGrid{Vec2(10, 20), 2.0, 2, 2}, 0.0);
  raster.pixels = {0.0, 4.0, 8.0, 12.0};
  EXPECT_DOUBLE_EQ(sample(raster, {11, 21}), 6.0);
  EXPECT_DOUBLE_EQ(sample(raster, {12, 20}), 4.0);
  EXPECT_DOUBLE_EQ(sample(raster, {100, 20}), 0.0);
  EXPECT_DOUBLE_EQ(sample(raster, {NAN, 20}), 0.0);
}

TEST(DepthBuffer, ShowsTheNearerOfTwoSurfacesAndItsHeight) {
  const Points points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}, {0, 0, 1}, {2, 0, 3}, {0, 2, 1}};
  const std::vector<Triangle> triangles{{v(0), v(1), v(2)}, {v(1), v(3), v(2)}, {v(4), v(5), v(6)}};
  const DepthBuffer buffer = depth_buffer(RasterGrid{Vec2::Zero(), 1.0, 6, 5}, points, triangles);
  EXPECT_EQ(buffer.triangles[buffer.offset(1, 0)], 2);
  EXPECT_NEAR(buffer.heights_mm[buffer.offset(1, 0)], 2.0, 1e-12);
  EXPECT_EQ(buffer.triangles[buffer.offset(3, 0)], 0);
  EXPECT_EQ(buffer.triangles[buffer.offset(3, 3)], 1);
  EXPECT_NEAR(buffer.heights_mm[buffer.offset(3, 3)], 0.0, 1e-12);
  EXPECT_EQ(buffer.triangles[buffer.offset(5, 0)], -1);
  EXPECT_TRUE(std::isnan(buffer.heights_mm[buffer.offset(5, 0)]));
}

TEST(DepthBuffer, RefusesWhatItCannotDraw) {
  const RasterGrid grid{Vec2::Zero(), 1.0, 4, 4};
  EXPECT_THROW((void)depth_buffer(grid, Points{{0, 0, 0}}, std::vector<Triangle>{{v(0), v(1), v(2)}}), InvalidArgument);
  EXPECT_THROW(
      (void)depth_buffer(grid, Points{{0, 0, NAN}, {1, 0, 0}, {0, 1, 0}}, std::vector<Triangle>{{v(0), v(1), v(2)}}),
      InvalidArgument);
}

}  // namespace
}  // namespace incise
