#include <incise/core/error.hpp>
#include <incise/core/quantile.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {

double quantile(std::span<const double> sorted, double share) {
  INCISE_REQUIRE(!sorted.empty() && share >= 0.0 && share <= 1.0,
                 fmt::format("expected numbers and a share from 0 to 1, found {} and {}", sorted.size(), share));
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(position);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (position - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

}  // namespace incise
