#include "calibration/sector_noise.hpp"

#include <incise/calibration/ring_profiles.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise {
namespace {

// Both lists are about even in their logarithms, with equal weights. The least amplitude represents "nothing in
// common".
constexpr std::array kCommonAmplitudeMm{0.02, 0.04, 0.08, 0.16, 0.32, 0.64};
constexpr std::array kCommonCorrelationDeg{25.0, 60.0, 120.0};
/// Prior sd of simulated_share about 1: a simulation that says nothing of differences lies two of these away.
constexpr double kShareSd = 0.5;

/// Mean over specimens of `value(specimen, sector)`.
template <class Value>
std::vector<double> mean_over_specimens(const std::vector<SpecimenFit>& specimens, const Value& value) {
  INCISE_REQUIRE(!specimens.empty() && !specimens.front().observed_mm.empty(), "expected at least one photograph");
  const std::size_t sectors = specimens.front().observed_mm.size();
  std::vector<double> mean(sectors, 0.0);
  for (const SpecimenFit& specimen : specimens) {
    INCISE_REQUIRE(specimen.observed_mm.size() == sectors && specimen.fitted_mm.size() == sectors,
                   fmt::format("{}: expected {} sectors, found {} photographed and {} fitted", specimen.name, sectors,
                               specimen.observed_mm.size(), specimen.fitted_mm.size()));
    for (std::size_t i = 0; i < sectors; ++i) mean[i] += value(specimen, i) / static_cast<double>(specimens.size());
  }
  return mean;
}

/// Variance of each wave of a specimen's residual, including the part in common with the others.
std::vector<double> total_variances(const ResidualEstimate& residual, std::size_t sectors) {
  std::vector<double> variances = ring_eigenvalues(sectors, residual.correlation_deg);
  const auto count = static_cast<double>(sectors);
  for (std::size_t j = 0; j < sectors; ++j) {
    variances[j] = residual.sd_mm * residual.sd_mm * variances[j] + residual.reading_mm * residual.reading_mm;
    if (j == 0) variances[j] += count * residual.specimen_spread_mm * residual.specimen_spread_mm;
    if (j == 1 || j == 2) variances[j] += 0.5 * count * residual.placement_mm * residual.placement_mm;
  }
  return variances;
}

/// The specimens' photographed and simulated profiles, wave by wave.
struct RingWaves {
  std::size_t specimens = 0;
  std::vector<double> mean_rest;                     ///< of photographed minus simulated errors
  std::vector<double> seen_seen, seen_own, own_own;  ///< sums of products of deviations from the mean over specimens
};

RingWaves waves_of(const std::vector<SpecimenFit>& specimens, const std::vector<double>& simulated) {
  const std::vector<double> photographed = photographed_profile(specimens).mean_mm;
  const std::size_t n = simulated.size();
  RingWaves waves{specimens.size(), {}, std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  std::vector<double> rest = photographed;
  for (std::size_t i = 0; i < n; ++i) rest[i] -= simulated[i];
  waves.mean_rest = ring_spectrum(rest);
  for (const SpecimenFit& specimen : specimens) {
    std::vector<double> own = specimen.fitted_mm, seen = specimen.observed_mm;
    for (std::size_t i = 0; i < n; ++i) {
      own[i] -= simulated[i];
      seen[i] -= photographed[i];
    }
    const std::vector<double> own_waves = ring_spectrum(own), seen_waves = ring_spectrum(seen);
    for (std::size_t j = 0; j < n; ++j) {
      waves.seen_seen[j] += seen_waves[j] * seen_waves[j];
      waves.seen_own[j] += seen_waves[j] * own_waves[j];
      waves.own_own[j] += own_waves[j] * own_waves[j];
    }
  }
  return waves;
}

/// One amplitude and correlation of the common part, the estimates that follow, and how well the photographs agree.
struct CommonPart {
  double amplitude_mm = 0.0, correlation_deg = 0.0;
  double share = 1.0, share_variance = 0.0;  ///< of simulated differences
  std::vector<double> mean, variance;        ///< of each wave of f
  double log_likelihood = 0.0;
};

CommonPart common_part(double amplitude_mm, double correlation_deg, const RingWaves& waves,
                       const std::vector<double>& total, double least_own) {
  CommonPart part{amplitude_mm, correlation_deg, 1.0, 0.0, {}, {}, 0.0};
  const std::vector<double> shape = ring_eigenvalues(total.size(), correlation_deg);
  const auto count = static_cast<double>(waves.specimens);
  double weight = 1.0 / (kShareSd * kShareSd), sum = weight;
  std::vector<double> own(total.size());
  for (std::size_t j = 0; j < total.size(); ++j) {
    const double common = amplitude_mm * amplitude_mm * shape[j];
    own[j] = std::max(total[j] - common, least_own);
    sum += waves.seen_own[j] / own[j];
    weight += waves.own_own[j] / own[j];
    const double of_mean = own[j] / count, trust = common / (common + of_mean);
    part.mean.push_back(trust * waves.mean_rest[j]);
    part.variance.push_back(trust * of_mean);
    part.log_likelihood -=
        0.5 * (std::log(common + of_mean) + waves.mean_rest[j] * waves.mean_rest[j] / (common + of_mean));
  }
  part.share = sum / weight;
  part.share_variance = 1.0 / weight;
  for (std::size_t j = 0; j < total.size(); ++j) {
    const double rest =
        waves.seen_seen[j] - 2.0 * part.share * waves.seen_own[j] + part.share * part.share * waves.own_own[j];
    part.log_likelihood -= 0.5 * ((count - 1.0) * std::log(own[j]) + rest / own[j]);
  }
  return part;
}

}  // namespace

PhotographedProfile photographed_profile(const std::vector<SpecimenFit>& specimens) {
  PhotographedProfile profile;
  profile.mean_mm =
      mean_over_specimens(specimens, [](const SpecimenFit& s, std::size_t i) { return s.observed_mm[i]; });
  profile.smoothed_mm = without_fast_waves(profile.mean_mm);
  for (const double error : profile.mean_mm) profile.constant_mm += error / static_cast<double>(profile.mean_mm.size());
  return profile;
}

ResidualProfile residual_profile(const DragFit& fit) {
  const ResidualEstimate& residual = fit.residual;
  INCISE_REQUIRE(residual.reading_mm > 0.0 && residual.correlation_deg > 0.0, "expected a fit with its residual");
  const std::vector<double> simulated =
      mean_over_specimens(fit.specimens, [](const SpecimenFit& s, std::size_t i) { return s.fitted_mm[i]; });
  const RingWaves waves = waves_of(fit.specimens, simulated);
  const std::vector<double> total = total_variances(residual, simulated.size());
  std::vector<CommonPart> parts;
  for (const double correlation : kCommonCorrelationDeg) {
    for (const double amplitude : kCommonAmplitudeMm)
      parts.push_back(common_part(amplitude, correlation, waves, total, residual.reading_mm * residual.reading_mm));
  }
  double most = -std::numeric_limits<double>::infinity();
  for (const CommonPart& part : parts) most = std::max(most, part.log_likelihood);
  double sum = 0.0;
  for (const CommonPart& part : parts) sum += std::exp(part.log_likelihood - most);
  ResidualProfile profile;
  profile.simulated_share = 0.0;
  double share_squares = 0.0;
  std::vector<double> mean(simulated.size(), 0.0), squares(simulated.size(), 0.0);
  for (const CommonPart& part : parts) {
    const double weight = std::exp(part.log_likelihood - most) / sum;
    profile.amplitude_mm += weight * part.amplitude_mm;
    profile.correlation_deg += weight * part.correlation_deg;
    profile.simulated_share += weight * part.share;
    share_squares += weight * (part.share_variance + part.share * part.share);
    for (std::size_t j = 0; j < mean.size(); ++j) {
      mean[j] += weight * part.mean[j];
      squares[j] += weight * (part.variance[j] + part.mean[j] * part.mean[j]);
    }
  }
  const double share = profile.simulated_share;
  profile.simulated_share_sd = std::sqrt(std::max(0.0, share_squares - share * share));
  double variance = 0.0;
  for (std::size_t j = 0; j < mean.size(); ++j)
    variance += std::max(0.0, squares[j] - mean[j] * mean[j]) / static_cast<double>(mean.size());
  profile.sd_mm = std::sqrt(variance);
  profile.mean_mm = ring_values(mean);
  for (std::size_t i = 0; i < simulated.size(); ++i) profile.mean_mm[i] += (1.0 - share) * simulated[i];
  return profile;
}

}  // namespace incise
