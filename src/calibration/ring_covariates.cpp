#include <incise/calibration/ring_covariates.hpp>
#include <incise/core/error.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kLowShare = 0.1, kHighShare = 0.9;

/// @param sorted  at least one.
double percentile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

CovariateValues values_of(const RingCovariates& ring) {
  return {std::log(ring.radius_mm),          ring.outline,           ring.along,    std::abs(ring.aside_mm),
          std::log(ring.youngs_modulus_kpa), ring.lateral_margin_mm, ring.depth_mm, std::log(ring.speed_mm_s)};
}

std::vector<std::size_t> outside_covariates(const RingCovariates& ring, std::span<const RingCovariates> others) {
  INCISE_REQUIRE(!others.empty(), "expected rings to compare with");
  const CovariateValues mine = values_of(ring);
  std::vector<std::size_t> outside;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    if (kRingCovariateNames[k] == "outline") continue;  // a regressor, but not of those that were fixed
    std::vector<double> sorted;
    for (const RingCovariates& other : others) sorted.push_back(values_of(other)[k]);
    std::sort(sorted.begin(), sorted.end());
    if (mine[k] < percentile(sorted, kLowShare) || mine[k] > percentile(sorted, kHighShare)) outside.push_back(k);
  }
  return outside;
}

}  // namespace incise
