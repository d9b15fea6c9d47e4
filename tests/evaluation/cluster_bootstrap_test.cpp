#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/cluster_bootstrap.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <vector>

namespace incise {
namespace {

using Clusters = std::vector<std::vector<double>>;

TEST(ClusterBootstrap, OfEqualClustersIsTheBootstrapOfTheirMeans) {
  // Two clusters: a quarter of the replicates has the mean of either, half that of all.
  const std::optional<Interval> found = cluster_bootstrap(Clusters{{1.0, 3.0}, {5.0, 7.0}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->low, 2.0);
  EXPECT_EQ(found->high, 6.0);
  EXPECT_EQ(cluster_bootstrap(Clusters{{1.0, 3.0}, {5.0, 7.0}}, {.level = 0.4})->low, 4.0);
}

TEST(ClusterBootstrap, WeighsClustersByTheirValues) {
  const std::optional<Interval> found = cluster_bootstrap(Clusters{{0.0}, {1.0, 1.0, 1.0}}, {.level = 0.4});
  EXPECT_EQ(found->low, 0.75) << "both drawn once: three of four values";
  EXPECT_EQ(found->high, 0.75);
}

TEST(ClusterBootstrap, HoldsTheTruthAsOftenAsItSaysWhereValuesOfAClusterAreAlike) {
  Random random(5);
  int held = 0, held_by_values = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    Clusters clusters(20), values;
    for (std::vector<double>& cluster : clusters) {
      const double common = random.normal();
      for (int i = 0; i < 8; ++i) {
        cluster.push_back(common + 0.3 * random.normal());
        values.push_back({cluster.back()});
      }
    }
    const Interval by_cluster = *cluster_bootstrap(clusters, {.replicates = 499, .seed = 3});
    const Interval by_value = *cluster_bootstrap(values, {.replicates = 499, .seed = 3});
    held += by_cluster.low <= 0.0 && by_cluster.high >= 0.0 ? 1 : 0;
    held_by_values += by_value.low <= 0.0 && by_value.high >= 0.0 ? 1 : 0;
  }
  EXPECT_GT(held, 0.89 * kTrials);
  EXPECT_LT(held_by_values, 0.65 * kTrials) << "as if each value were new";
}

TEST(ClusterBootstrap, NeedsTwoClustersWithValues) {
  EXPECT_FALSE(cluster_bootstrap(Clusters{}));
  EXPECT_FALSE(cluster_bootstrap(Clusters{{1.0, 2.0}, {}}));
  EXPECT_THROW(static_cast<void>(cluster_bootstrap(Clusters{{std::numeric_limits<double>::quiet_NaN()}, {1.0}})),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(cluster_bootstrap(Clusters{{0.0}, {1.0}}, {.replicates = 9})), InvalidArgument);
}

}  // namespace
}  // namespace incise
