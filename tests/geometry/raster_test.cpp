#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/geometry/raster.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

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

TEST(DepthBuffer, SeesCentresWithinATriangleAndOnItsBorderWhicheverWayItTurns) {
  const Points corners{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  for (const Triangle& triangle : {Triangle{v(0), v(1), v(2)}, Triangle{v(0), v(2), v(1)}}) {
    const DepthBuffer buffer = depth_buffer(RasterGrid{Vec2::Zero(), 1.0, 4, 4}, corners, std::vector{triangle});
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) EXPECT_EQ(buffer.triangles[buffer.offset(i, j)], i + j <= 3 ? 0 : -1);
    }
  }
}

TEST(DepthBuffer, HasNoCrackBetweenNeighbours) {
  Random random(6);
  const std::vector<Triangle> fan{{v(0), v(1), v(2)}, {v(0), v(2), v(3)}, {v(0), v(3), v(4)}, {v(0), v(4), v(1)}};
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 middle(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    const Points points{middle, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
    for (const std::int32_t seen : depth_buffer(grid_around({-2, -2}, {2, 2}, 0.1, 0.0), points, fan).triangles) {
      ASSERT_GE(seen, 0);
    }
  }
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
