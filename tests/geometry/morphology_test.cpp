#include "geometry/pictures.hpp"

#include <incise/core/random.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/geometry/morphology.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using testing::as_text;
using testing::drawn;
using Rows = std::vector<std::string>;

Raster noise(Random& random, int width, int height, double share) {
  Raster raster(RasterGrid{Vec2::Zero(), 0.5, width, height}, 0);
  for (std::uint8_t& pixel : raster.pixels) pixel = random.uniform() < share ? 1 : 0;
  return raster;
}

TEST(DistanceTo, AgreesWithTheDefinition) {
  Random random(12);
  for (const double share : {0.02, 0.3, 0.9}) {
    const Raster raster = noise(random, 23, 17, share);
    const ScalarRaster distance = distance_to(raster, 1);
    for (int j = 0; j < raster.height; ++j) {
      for (int i = 0; i < raster.width; ++i) {
        double expected = INFINITY;
        for (int y = 0; y < raster.height; ++y) {
          for (int x = 0; x < raster.width; ++x) {
            if (raster.at(x, y) == 1) expected = std::min(expected, 0.5 * std::hypot(x - i, y - j));
          }
        }
        ASSERT_NEAR(distance.at(i, j), expected, 1e-12) << i << " " << j;
      }
    }
  }
}

TEST(DistanceTo, IsInfiniteWhenThereIsNothing) {
  const Raster empty(RasterGrid{Vec2::Zero(), 1.0, 3, 2}, 0);
  for (const double distance : distance_to(empty, 1).pixels) EXPECT_TRUE(std::isinf(distance));
}

TEST(Dilated, AddsADisc) {
  EXPECT_EQ(as_text(dilated(drawn({".....", ".....", "..#..", ".....", "....."}), 1.0)),
            (Rows{".....", "..#..", ".###.", "..#..", "....."}));
}

TEST(Eroded, TakesADiscAwayButNothingFromThePicturesFrame) {
  EXPECT_EQ(as_text(eroded(drawn({"####", "####", "####", "...."}), 1.0)), (Rows{"####", "####", "....", "...."}));
}

TEST(ClosedAndOpened, AddNothingElseAndRemoveNothingElse) {
  Random random(13);
  for (int trial = 0; trial < 10; ++trial) {
    const Raster raster = noise(random, 30, 25, 0.4);
    const Raster after_closing = closed(raster, 0.8);
    const Raster after_opening = opened(raster, 0.8);
    for (std::size_t p = 0; p < raster.pixels.size(); ++p) {
      EXPECT_LE(raster.pixels[p], after_closing.pixels[p]);
      EXPECT_GE(raster.pixels[p], after_opening.pixels[p]);
    }
    EXPECT_EQ(closed(after_closing, 0.8).pixels, after_closing.pixels) << "closing twice changes nothing";
    EXPECT_EQ(opened(after_opening, 0.8).pixels, after_opening.pixels) << "opening twice changes nothing";
  }
}

TEST(Closed, JoinsAcrossAGapOfOnePixel) {
  EXPECT_EQ(as_text(closed(drawn({".........", "..##.##..", "..##.##..", "..##.##..", "........."}), 1.0)),
            (Rows{".........", "..##.##..", "..#####..", "..##.##..", "........."}));
}

TEST(FindComponents, CountsByTheGivenConnectivity) {
  const Raster raster = drawn({"#....", ".#...", "...##", "...##"});
  EXPECT_EQ(find_components(raster, 1, Connectivity::Four).parts.size(), 3U);
  const Components parts = find_components(raster, 1, Connectivity::Eight);
  ASSERT_EQ(parts.parts.size(), 2U);
  EXPECT_EQ(parts.parts[0].pixels, 2U);
  EXPECT_EQ(parts.parts[1].pixels, 4U);
  EXPECT_EQ(largest_part(parts), 1);
  EXPECT_EQ(as_text(part_of(raster, parts, 0)), (Rows{"#....", ".#...", ".....", "....."}));
  EXPECT_TRUE(parts.parts[1].touches_border);
  EXPECT_EQ(largest_part(find_components(drawn({"..."}), 1, Connectivity::Four)), std::nullopt);
}

TEST(HolesFilled, FillsUpToTheGivenArea) {
  const Raster raster = drawn({"#######", "#.#...#", "#.#...#", "#######", "#......"});
  EXPECT_EQ(as_text(holes_filled(raster, 2.0)), (Rows{"#######", "###...#", "###...#", "#######", "#......"}));
  EXPECT_EQ(as_text(holes_filled(raster, 6.0)), (Rows{"#######", "#######", "#######", "#######", "#......"}));
  EXPECT_EQ(holes_filled(raster, 0.0).pixels, raster.pixels);
}

TEST(Blurred, KeepsTheSumAndSpreadsByItsSigma) {
  Raster raster(RasterGrid{Vec2::Zero(), 0.1, 81, 81}, 0);
  raster.at(40, 40) = 1;
  const ScalarRaster result = blurred(raster, 0.5);
  double sum = 0.0;
  double variance = 0.0;
  for (int j = 0; j < 81; ++j) {
    for (int i = 0; i < 81; ++i) {
      sum += result.at(i, j);
      variance += result.at(i, j) * 0.01 * (i - 40) * (i - 40);
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(std::sqrt(variance), 0.5, 0.001);
  EXPECT_DOUBLE_EQ(blurred(raster, 0.0).at(40, 40), 1.0);
}

TEST(Blurred, IsOneHalfOnAStraightEdge) {
  Raster raster(RasterGrid{Vec2::Zero(), 0.1, 60, 60}, 0);
  for (int j = 0; j < 60; ++j) {
    for (int i = 0; i < 30; ++i) raster.at(i, j) = 1;
  }
  const ScalarRaster result = blurred(raster, 0.3);
  EXPECT_NEAR(sample(result, {2.95, 3.0}), 0.5, 1e-9);
}

}  // namespace
}  // namespace incise
