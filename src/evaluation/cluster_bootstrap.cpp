#include <incise/core/error.hpp>
#include <incise/core/quantile.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/cluster_bootstrap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace incise {

std::optional<Interval> cluster_bootstrap(std::span<const std::vector<double>> clusters,
                                          const BootstrapSettings& settings) {
  INCISE_REQUIRE(settings.replicates >= 99 && settings.level > 0.0 && settings.level < 1.0,
                 fmt::format("expected at least 99 replicates and a level between 0 and 1, found {} and {}",
                             settings.replicates, settings.level));
  std::vector<std::pair<double, double>> sums;  // of a cluster: its values' sum and number
  for (const std::vector<double>& values : clusters) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    INCISE_REQUIRE(std::isfinite(sum), "expected finite values");
    if (!values.empty()) sums.emplace_back(sum, static_cast<double>(values.size()));
  }
  if (sums.size() < 2) return std::nullopt;
  Random random(settings.seed);
  std::vector<double> means(static_cast<std::size_t>(settings.replicates));
  for (double& mean : means) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto& [of_cluster, size] = sums[random.below(sums.size())];
      sum += of_cluster;
      count += size;
    }
    mean = sum / count;
  }
  std::sort(means.begin(), means.end());
  return Interval{quantile(means, 0.5 * (1.0 - settings.level)), quantile(means, 0.5 * (1.0 + settings.level))};
}

}  // namespace incise
