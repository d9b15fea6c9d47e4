#pragma once

#include <incise/evaluation/block_bootstrap.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Interval of the mean of all values, where values of one cluster have something in common: the percentiles of
/// replicates that draw whole clusters anew, as many as there are [DavisonHinkley1997, section 3.8]. With few clusters
/// it is too narrow. Empty clusters are left out. O(replicates · clusters).
/// @returns nothing for fewer than two clusters. @throws InvalidArgument for values that are not finite, or settings
/// out of range.
[[nodiscard]] std::optional<Interval> cluster_bootstrap(std::span<const std::vector<double>> clusters,
                                                        const BootstrapSettings& settings = {});

}  // namespace incise
