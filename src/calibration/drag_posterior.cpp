#include "calibration/drag_posterior.hpp"

#include "calibration/sector_noise.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::size_t kDragSteps = 41;
constexpr std::size_t kStiffnessSteps = 15;
constexpr double kStiffnessReach = 2.5;  // standard deviations of the prior

// The residual's parameters are integrated over. Each list is about even in its logarithm, so equal weights are
// Jeffreys' prior of a scale, cut off beyond plausible values.
constexpr std::array kResidualSdMm{0.1, 0.14, 0.2, 0.28, 0.4, 0.56, 0.8};
constexpr std::array kCorrelationDeg{10.0, 25.0, 60.0, 120.0};
/// Uncorrelated from sector to sector: reading of the photograph, grain of the mesh; in multiples of the least one.
constexpr std::array kReadingTimes{1.0, 2.0, 3.5};
/// From specimen to specimen; half-normal weights, because two or three specimens hardly determine it.
constexpr std::array kSpreadMm{0.05, 0.15, 0.3, 0.5};
constexpr double kSpreadPriorMm = 0.25;
/// Of the shift of a whole cut; half-normal weights.
constexpr std::array kPlacementMm{0.1, 0.3, 0.6};
constexpr double kPlacementPriorMm = 0.4;

/// Spectra of photographed minus simulated errors, and of the slope by stiffness, one pair for each drag length.
struct SpecimenSpectra {
  std::vector<std::vector<double>> rest;
  std::vector<std::vector<double>> slope;
  std::vector<double> grain_variance;  ///< of a sector of the simulation, mm²
  double own_variance = 0.0;
};

/// Sums over the waves above order 0, weighted by the inverse variance of each.
struct WaveSums {
  double rest_rest = 0.0, rest_slope = 0.0, slope_slope = 0.0;
  double log_determinant = 0.0;
  double variance_0 = 0.0;  ///< of the wave of order 0, without what differs from specimen to specimen
};

/// Sums over the specimens at one cell of the grid: terms of −2 ln(mass), and the normal equation of the bias.
struct BiasEquation {
  double log_determinant = 0.0;
  double squares = 0.0;
  double weight = 0.0;  ///< 1ᵀ C⁻¹ 1
  double pull = 0.0;    ///< 1ᵀ C⁻¹ r
};

struct ResidualChoice {
  double sd_mm, correlation_deg, reading_mm, placement_mm, spread_mm;
  double correlation_0 = 0.0;  ///< eigenvalue of order 0 of the correlation
};

std::vector<double> evenly(double from, double to, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] =
        count == 1 ? 0.5 * (from + to) : from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return values;
}

SpecimenSpectra spectra_of(const FitSpecimen& specimen, const std::vector<double>& drag_lengths) {
  SpecimenSpectra spectra;
  spectra.own_variance = specimen.own_stiffness_sd * specimen.own_stiffness_sd;
  // In the fast waves the simulation shows only its grain. Only the photograph counts there, and shows how rough the
  // difference is.
  const std::vector<double> observed = ring_spectrum(specimen.signed_error_mm);
  for (const double drag : drag_lengths) {
    std::vector<double> rest = observed;
    std::vector<double> slope = ring_spectrum(specimen.response.stiffness_slope(drag));
    const std::vector<double> simulated = ring_spectrum(specimen.response.at(drag));
    const std::size_t slow = std::min(rest.size(), kEntriesThatCount);
    for (std::size_t j = 0; j < slow; ++j) rest[j] -= simulated[j];
    std::fill(slope.begin() + static_cast<std::ptrdiff_t>(slow), slope.end(), 0.0);
    spectra.rest.push_back(std::move(rest));
    spectra.slope.push_back(std::move(slope));
    // Midway between two knots the grain of both averages out. With one variance everywhere, the fit would be drawn to
    // these places.
    spectra.grain_variance.push_back(std::pow(specimen.response.grain_mm(), 2) * specimen.response.grain_share(drag));
  }
  return spectra;
}

WaveSums wave_sums(const std::vector<double>& rest, const std::vector<double>& slope,
                   const std::vector<double>& variances, double grain_variance) {
  WaveSums sums;
  sums.variance_0 = variances[0] + grain_variance;
  for (std::size_t j = 1; j < rest.size(); ++j) {
    const double variance = variances[j] + (j < kEntriesThatCount ? grain_variance : 0.0);
    sums.rest_rest += rest[j] * rest[j] / variance;
    sums.rest_slope += rest[j] * slope[j] / variance;
    sums.slope_slope += slope[j] * slope[j] / variance;
    sums.log_determinant += std::log(variance);
  }
  return sums;
}

/// Adds one specimen. Its covariance is diagonal in the spectrum except for the rank-one part of its own stiffness,
/// which the Sherman–Morrison formula includes.
void add_specimen(BiasEquation& sum, const WaveSums& waves, double rest_0, double slope_0, double spread_mm,
                  double ln_stiffness, double own_variance, double sectors) {
  const double variance_0 = waves.variance_0 + sectors * spread_mm * spread_mm;
  const double x = ln_stiffness;
  const double r0 = rest_0 - x * slope_0;
  const double rr = waves.rest_rest - 2.0 * x * waves.rest_slope + x * x * waves.slope_slope + r0 * r0 / variance_0;
  const double rg = waves.rest_slope - x * waves.slope_slope + r0 * slope_0 / variance_0;
  const double gg = waves.slope_slope + slope_0 * slope_0 / variance_0;
  const double ur = std::sqrt(sectors) * r0 / variance_0;
  const double ug = std::sqrt(sectors) * slope_0 / variance_0;
  const double share = own_variance / (1.0 + own_variance * gg);
  sum.log_determinant += waves.log_determinant + std::log(variance_0) + std::log1p(own_variance * gg);
  sum.squares += rr - share * rg * rg;
  sum.weight += sectors / variance_0 - share * ug * ug;
  sum.pull += ur - share * ug * rg;
}

std::array<double*, 6> sums_of(ResidualEstimate& residual) {
  return {&residual.sd_mm,        &residual.correlation_deg, &residual.reading_mm, &residual.specimen_spread_mm,
          &residual.placement_mm, &residual.n_effective};
}

/// Collects the grid, one choice of the residual's parameters after the other. Masses are relative to the greatest so
/// far, which keeps their exponentials in range.
class GridSum {
 public:
  GridSum(const std::vector<FitSpecimen>& specimens, const DragFitSettings& settings, DragPosterior& posterior)
      : settings_(settings), posterior_(posterior), sectors_(specimens.front().response.sectors()) {
    for (const FitSpecimen& specimen : specimens) spectra_.push_back(spectra_of(specimen, posterior.drag_lengths_mm));
    posterior_.cells.assign(posterior.drag_lengths_mm.size() * posterior.ln_stiffness.size(), {});
  }

  /// @param choice  its spread is ignored: all spreads are added.
  void add(ResidualChoice choice) {
    std::vector<double> variances = ring_eigenvalues(sectors_, choice.correlation_deg);
    choice.correlation_0 = variances[0];
    for (std::size_t j = 0; j < sectors_; ++j) {
      variances[j] = choice.sd_mm * choice.sd_mm * variances[j] + choice.reading_mm * choice.reading_mm;
      // A ring that is shifted as a whole errs by a cosine of order 1.
      if (j == 1 || j == 2) {
        variances[j] += 0.5 * static_cast<double>(sectors_) * choice.placement_mm * choice.placement_mm;
      }
    }
    for (std::size_t drag = 0; drag < posterior_.drag_lengths_mm.size(); ++drag) {
      std::vector<WaveSums> waves;
      for (const SpecimenSpectra& s : spectra_)
        waves.push_back(wave_sums(s.rest[drag], s.slope[drag], variances, s.grain_variance[drag]));
      for (const double spread : kSpreadMm) {
        choice.spread_mm = spread;
        add_row(drag, choice, waves);
      }
    }
  }

  void finish() {
    for (PosteriorCell& cell : posterior_.cells) {
      if (cell.mass <= 0.0) continue;
      cell.bias_mean_mm /= cell.mass;
      cell.bias_variance_mm2 = cell.bias_variance_mm2 / cell.mass - cell.bias_mean_mm * cell.bias_mean_mm;
      cell.mass /= total_;
    }
    for (double* sum : sums_of(posterior_.residual)) *sum /= total_;
  }

 private:
  void add_row(std::size_t drag, const ResidualChoice& choice, const std::vector<WaveSums>& waves) {
    const auto sectors = static_cast<double>(sectors_);
    const double log_prior =
        -0.5 * (std::pow(choice.spread_mm / kSpreadPriorMm, 2) + std::pow(choice.placement_mm / kPlacementPriorMm, 2));
    const double prior_weight = 1.0 / (settings_.bias_sd_mm * settings_.bias_sd_mm);
    for (std::size_t k = 0; k < posterior_.ln_stiffness.size(); ++k) {
      const double x = posterior_.ln_stiffness[k];
      BiasEquation sum;
      for (std::size_t s = 0; s < spectra_.size(); ++s) {
        add_specimen(sum, waves[s], spectra_[s].rest[drag][0], spectra_[s].slope[drag][0], choice.spread_mm, x,
                     spectra_[s].own_variance, sectors);
      }
      const double weight = sum.weight + prior_weight;
      const double log_mass = -0.5 * (sum.log_determinant + std::log(weight / prior_weight) + sum.squares -
                                      sum.pull * sum.pull / weight + std::pow(x / settings_.stiffness_sd, 2)) +
                              log_prior;
      collect(drag * posterior_.ln_stiffness.size() + k, relative(log_mass), sum.pull / weight, 1.0 / weight, choice);
    }
  }

  /// Returns the mass relative to the reference, which is raised if the mass lies far above it.
  double relative(double log_mass) {
    constexpr double kFar = 30.0;
    if (log_mass > reference_ + kFar) {
      const double factor = std::exp(reference_ - log_mass);
      reference_ = log_mass;
      for (PosteriorCell& cell : posterior_.cells) {
        for (double* sum : {&cell.mass, &cell.bias_mean_mm, &cell.bias_variance_mm2}) *sum *= factor;
      }
      for (double* sum : sums_of(posterior_.residual)) *sum *= factor;
      total_ *= factor;
    }
    return std::exp(log_mass - reference_);
  }

  void collect(std::size_t at, double mass, double bias_mean, double bias_variance, const ResidualChoice& choice) {
    PosteriorCell& cell = posterior_.cells[at];
    cell.mass += mass;
    cell.bias_mean_mm += mass * bias_mean;
    cell.bias_variance_mm2 += mass * (bias_variance + bias_mean * bias_mean);
    ResidualEstimate& residual = posterior_.residual;
    residual.sd_mm += mass * choice.sd_mm;
    residual.correlation_deg += mass * choice.correlation_deg;
    residual.reading_mm += mass * choice.reading_mm;
    residual.placement_mm += mass * choice.placement_mm;
    residual.specimen_spread_mm += mass * choice.spread_mm;
    const double reading = choice.reading_mm * choice.reading_mm;
    const double variance = choice.sd_mm * choice.sd_mm;
    residual.n_effective +=
        mass * static_cast<double>(sectors_) * (variance + reading) / (variance * choice.correlation_0 + reading);
    total_ += mass;
  }

  const DragFitSettings& settings_;
  DragPosterior& posterior_;
  std::size_t sectors_;
  std::vector<SpecimenSpectra> spectra_;
  double reference_ = -1e300;
  double total_ = 0.0;
};

}  // namespace

DragPosterior posterior_on_grid(const std::vector<FitSpecimen>& specimens, const DragFitSettings& settings) {
  DragPosterior posterior;
  double least = 0.0;
  double most = std::numeric_limits<double>::infinity();
  posterior.knows_stiffness = true;
  for (const FitSpecimen& specimen : specimens) {
    least = std::max(least, specimen.response.least_mm());
    most = std::min(most, specimen.response.most_mm());
    posterior.knows_stiffness = posterior.knows_stiffness && specimen.response.knows_stiffness();
  }
  INCISE_REQUIRE(least < most,
                 fmt::format("expected a range of drag lengths over which all specimens were simulated, found none: "
                             "it would begin at {} mm and end at {} mm",
                             least, most));
  posterior.drag_lengths_mm = evenly(least, most, kDragSteps);
  const double reach = kStiffnessReach * settings.stiffness_sd;
  posterior.ln_stiffness = evenly(-reach, reach, posterior.knows_stiffness ? kStiffnessSteps : 1);
  GridSum sum(specimens, settings, posterior);
  for (const double sd : kResidualSdMm) {
    for (const double correlation : kCorrelationDeg) {
      for (const double times : kReadingTimes) {
        for (const double placement : kPlacementMm) {
          sum.add({sd, correlation, times * settings.reading_sd_mm, placement, 0.0});
        }
      }
    }
  }
  sum.finish();
  return posterior;
}

}  // namespace incise
