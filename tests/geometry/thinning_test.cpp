#include "geometry/pictures.hpp"

#include <incise/core/random.hpp>
#include <incise/geometry/morphology.hpp>
#include <incise/geometry/thinning.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::as_text;
using testing::drawn;
using Rows = std::vector<std::string>;

TEST(Thinned, LeavesTheMiddleRowOfABar) {
  const Raster skeleton = thinned(drawn({".........", ".#######.", ".#######.", ".#######.", "........."}));
  for (int i = 3; i <= 5; ++i) {
    EXPECT_EQ(skeleton.at(i, 1), 0);
    EXPECT_EQ(skeleton.at(i, 2), 1);
    EXPECT_EQ(skeleton.at(i, 3), 0);
  }
}

TEST(Thinned, LeavesALineOfOnePixelAsItIs) {
  const Rows line{"......", ".#....", "..##..", "....#.", "......"};
  EXPECT_EQ(as_text(thinned(drawn(line))), line);
}

TEST(Thinned, TakesTheCornersOffAStaircase) {
  EXPECT_EQ(as_text(thinned(drawn({"......", ".##...", "..##..", "...##.", "......"}))),
            (Rows{"......", ".#....", "..#...", "...##.", "......"}));
}

TEST(Thinned, KeepsThePartsAndHolesOfRandomBlobs) {
  Random random(14);
  for (int trial = 0; trial < 20; ++trial) {
    Raster raster(RasterGrid{Vec2::Zero(), 1.0, 60, 60}, 0);
    for (int disc = 0; disc < 25; ++disc) {
      testing::stamp_disc(raster, {random.uniform(6, 54), random.uniform(6, 54)}, random.uniform(1.5, 4.5));
    }
    const Raster skeleton = thinned(raster);
    EXPECT_EQ(find_components(skeleton, 1, Connectivity::Eight).parts.size(),
              find_components(raster, 1, Connectivity::Eight).parts.size());
    EXPECT_EQ(find_components(skeleton, 0, Connectivity::Four).parts.size(),
              find_components(raster, 0, Connectivity::Four).parts.size());
    for (std::size_t p = 0; p < raster.pixels.size(); ++p) EXPECT_LE(skeleton.pixels[p], raster.pixels[p]);
  }
}

TEST(Thinned, RunsAlongTheMiddleOfARing) {
  const Raster skeleton = thinned(testing::ring(8.0, 10.0, 0.1));
  for (int j = 0; j < skeleton.height; ++j) {
    for (int i = 0; i < skeleton.width; ++i) {
      if (skeleton.at(i, j) != 0) {
        EXPECT_NEAR(skeleton.centre(i, j).norm(), 9.0, 0.25);
      }
    }
  }
}

}  // namespace
}  // namespace incise
