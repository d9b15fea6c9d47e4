#include <incise/core/error.hpp>
#include <incise/core/quantile.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace incise {
namespace {

TEST(Quantile, IsLinearBetweenNeighbours) {
  const std::vector<double> sorted{1.0, 2.0, 4.0};
  EXPECT_EQ(quantile(sorted, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.25), 1.5);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.75), 3.0);
  EXPECT_EQ(quantile(sorted, 1.0), 4.0);
  EXPECT_THROW(static_cast<void>(quantile({}, 0.5)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(quantile(sorted, 1.1)), InvalidArgument);
}

}  // namespace
}  // namespace incise
