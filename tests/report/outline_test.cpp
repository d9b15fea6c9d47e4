#include "report/outline.hpp"

#include <incise/core/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace incise {
namespace {

TEST(OutlinePath, SurroundsASingleElementWithADiamond) {
  const std::vector<double> values{0, 0, 0, 0, 1, 0, 0, 0, 0};
  EXPECT_EQ(outline_path(values, 3, 3, 0.5, 1.0, 1.0), "M1.50 1.00L2.00 1.50L1.50 2.00L1.00 1.50Z");
}

TEST(OutlinePath, LiesWhereTheLevelIsCrossed) {
  // From 0 to 1 the level 0.25 lies a quarter of the way between the centres, at 0.75; elements are 2 x 1.
  const std::vector<double> values{0, 1, 0, 1};
  EXPECT_EQ(outline_path(values, 2, 2, 0.25, 2.0, 1.0), "M1.50 1.50L1.50 0.50");
}

TEST(OutlinePath, IsEmptyWithoutABorder) {
  EXPECT_EQ(outline_path(std::vector<double>(9, 1.0), 3, 3, 0.5, 1.0, 1.0), "");
  EXPECT_EQ(outline_path(std::vector<double>(9, 0.0), 3, 3, 0.5, 1.0, 1.0), "");
}

TEST(OutlinePath, KeepsAClosedCurveWhole) {
  std::vector<double> disc;
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) disc.push_back(12.0 - std::hypot(column - 20.0, row - 20.0));
  }
  const std::string path = outline_path(disc, 40, 40, 0.0, 1.0, 1.0);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 1);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'Z'), 1);
}

TEST(OutlinePath, RefusesAGridOfAnotherSize) {
  EXPECT_THROW(static_cast<void>(outline_path(std::vector<double>(8, 0.0), 3, 3, 0.5, 1.0, 1.0)), InvalidArgument);
}

}  // namespace
}  // namespace incise
