#include <incise/core/nearest_name.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace incise {
namespace {

TEST(NearestName, FindsWhatWasMeant) {
  const std::vector<std::string> names{"waypoints", "frame", "kind", "closed"};
  EXPECT_EQ(nearest_name("waypionts", names), "waypoints");
  EXPECT_EQ(nearest_name("Frame", names), "frame");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, AllowsEditsForAThirdOfTheLongerWordAndAlwaysOne) {
  EXPECT_EQ(nearest_name("rnu", {"run"}), "run");
  EXPECT_EQ(nearest_name("ro", {"run"}), "");
  EXPECT_EQ(nearest_name("lokcnig", {"locking"}), "locking");
  EXPECT_EQ(nearest_name("foo", {"demo", "run"}), "");
  EXPECT_EQ(nearest_name("nonsense", {"depth", "locking"}), "");
  EXPECT_EQ(nearest_name("--bogus", {"--help", "--json"}), "");
}

TEST(NearestName, TakesANameThatContainsTheWord) {
  EXPECT_EQ(nearest_name("elasticity", {"depth_mm", "elasticity_map"}), "elasticity_map");
  EXPECT_EQ(nearest_name("modulus", {"depth_mm", "youngs_modulus_kpa"}), "youngs_modulus_kpa");
  EXPECT_EQ(nearest_name("depth", {"depth_at_the_margin_mm", "depths"}), "depths") << "the nearer of two";
  EXPECT_EQ(nearest_name("ma", {"elasticity_map"}), "") << "too short";
}

TEST(DidYouMean, IsAHintOnlyWhereANameIsNear) {
  EXPECT_EQ(did_you_mean("depht", {"depth"}), "Did you mean 'depth'?");
  EXPECT_EQ(did_you_mean("nonsense", {"depth"}), "");
}

}  // namespace
}  // namespace incise
