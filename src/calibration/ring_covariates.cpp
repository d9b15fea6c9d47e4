#include <incise/calibration/ring_covariates.hpp>
#include <incise/core/error.hpp>
#include <incise/core/quantile.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kLowShare = 0.1, kHighShare = 0.9;

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
    if (kRingCovariateNames[k] == "outline") continue;  // a regressor, but not among those fixed in advance
    std::vector<double> sorted;
    for (const RingCovariates& other : others) sorted.push_back(values_of(other)[k]);
    std::sort(sorted.begin(), sorted.end());
    if (mine[k] < quantile(sorted, kLowShare) || mine[k] > quantile(sorted, kHighShare)) outside.push_back(k);
  }
  return outside;
}

}  // namespace incise
