#pragma once

#include <incise/evaluation/block_bootstrap.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Computes an interval of the mean of all values, for values that are correlated within clusters: percentiles of
/// replicates, each of which redraws as many whole clusters as there are [DavisonHinkley1997, section 3.8]. With few
/// clusters the interval is too narrow. Empty clusters are ignored. O(replicates · clusters).
/// @returns nothing for fewer than two clusters.
/// @throws InvalidArgument for values that are not finite, or settings out of range.
[[nodiscard]] std::optional<Interval> cluster_bootstrap(std::span<const std::vector<double>> clusters,
                                                        const BootstrapSettings& settings = {});

}  // namespace incise
