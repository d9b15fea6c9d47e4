#include "calibration/drag_posterior.hpp"

#include <incise/evaluation/statistics.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr std::size_t kBiasSteps = 81;
constexpr double kBiasReach = 4.0;  // standard deviations about the mean

/// Quantile of the standard normal distribution, by bisection.
double normal_place(double probability) {
  double low = -10.0;
  double high = 10.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (normal_share_below(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Quantile of masses on an even grid. A cell's mass is spread evenly over its width, which ends at the grid for the
/// first and last cell.
double place_of(const std::vector<double>& grid, const std::vector<double>& mass, double probability) {
  if (grid.size() == 1) return grid.front();
  const double half = 0.5 * (grid[1] - grid[0]);
  double below = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (below + mass[i] >= probability || i + 1 == grid.size()) {
      const double from = std::max(grid.front(), grid[i] - half);
      const double to = std::min(grid.back(), grid[i] + half);
      const double share = mass[i] > 0.0 ? std::clamp((probability - below) / mass[i], 0.0, 1.0) : 0.0;
      return from + share * (to - from);
    }
    below += mass[i];
  }
  return grid.back();
}

ParameterEstimate estimate_of(const std::vector<double>& grid, const std::vector<double>& mass, double credible) {
  ParameterEstimate estimate;
  estimate.grid = grid;
  double squares = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    estimate.mean += mass[i] * grid[i];
    squares += mass[i] * grid[i] * grid[i];
  }
  const double step = grid.size() > 1 ? grid[1] - grid[0] : 1.0;
  for (const double m : mass) estimate.density.push_back(m / step);
  estimate.sd = std::sqrt(std::max(0.0, squares - estimate.mean * estimate.mean));
  estimate.low = place_of(grid, mass, 0.5 * (1.0 - credible));
  estimate.high = place_of(grid, mass, 0.5 * (1.0 + credible));
  return estimate;
}

/// Fraction of the bias' mixture below a value.
double bias_below(const DragPosterior& posterior, double value) {
  double sum = 0.0;
  for (const PosteriorCell& cell : posterior.cells) {
    if (cell.mass > 0.0)
      sum += cell.mass * normal_share_below((value - cell.bias_mean_mm) / std::sqrt(cell.bias_variance_mm2));
  }
  return sum;
}

double bias_place(const DragPosterior& posterior, double low, double high, double probability) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (bias_below(posterior, middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ParameterEstimate bias_estimate(const DragPosterior& posterior, const DragFitSettings& settings) {
  ParameterEstimate bias;
  double squares = 0.0;
  for (const PosteriorCell& cell : posterior.cells) {
    bias.mean += cell.mass * cell.bias_mean_mm;
    squares += cell.mass * (cell.bias_variance_mm2 + cell.bias_mean_mm * cell.bias_mean_mm);
  }
  bias.sd = std::sqrt(std::max(0.0, squares - bias.mean * bias.mean));
  bias.prior_sd = settings.bias_sd_mm;
  const double reach = 10.0 * bias.sd;
  bias.low = bias_place(posterior, bias.mean - reach, bias.mean + reach, 0.5 * (1.0 - settings.credible));
  bias.high = bias_place(posterior, bias.mean - reach, bias.mean + reach, 0.5 * (1.0 + settings.credible));
  for (std::size_t i = 0; i < kBiasSteps; ++i) {
    const double at = bias.mean + bias.sd * kBiasReach * (2.0 * static_cast<double>(i) / (kBiasSteps - 1) - 1.0);
    double density = 0.0;
    for (const PosteriorCell& cell : posterior.cells) {
      const double sd = std::sqrt(cell.bias_variance_mm2);
      if (cell.mass > 0.0) density += cell.mass * normal_density((at - cell.bias_mean_mm) / sd) / sd;
    }
    bias.grid.push_back(at);
    bias.density.push_back(density);
  }
  return bias;
}

Mat3 correlation_of(const DragPosterior& posterior, const DragFit& fit) {
  const Vec3 mean(fit.drag_length_mm.mean, fit.ln_stiffness.mean, fit.bias_mm.mean);
  Mat3 covariance = Mat3::Zero();
  for (std::size_t i = 0; i < posterior.drag_lengths_mm.size(); ++i) {
    for (std::size_t k = 0; k < posterior.ln_stiffness.size(); ++k) {
      const PosteriorCell& cell = posterior.at(i, k);
      const Vec3 off = Vec3(posterior.drag_lengths_mm[i], posterior.ln_stiffness[k], cell.bias_mean_mm) - mean;
      covariance += cell.mass * off * off.transpose();
      covariance(2, 2) += cell.mass * cell.bias_variance_mm2;
    }
  }
  Mat3 correlation = Mat3::Identity();
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double scale = std::sqrt(covariance(a, a) * covariance(b, b));
      if (a != b) correlation(a, b) = scale > 0.0 ? covariance(a, b) / scale : 0.0;
    }
  }
  return correlation;
}

/// Returns the n-th number of a sequence that fills (0, 1) evenly, whatever its length (van der Corput).
double evenly_filling(std::size_t n) {
  double value = 0.0;
  double digit = 0.5;
  for (++n; n > 0; n /= 2, digit *= 0.5) value += digit * static_cast<double>(n % 2);
  return value;
}

/// Samples cells at even steps of the cumulated mass, each with a bias from its normal: as good as many more random
/// draws.
std::vector<PosteriorSample> samples_of(const DragPosterior& posterior, std::size_t count) {
  std::vector<PosteriorSample> samples;
  const double weight = 1.0 / static_cast<double>(count);
  double below = 0.0;
  for (std::size_t cell = 0; cell < posterior.cells.size(); ++cell) {
    const PosteriorCell& here = posterior.cells[cell];
    below += here.mass;
    while (samples.size() < count && (static_cast<double>(samples.size()) + 0.5) * weight <= below) {
      const double bias =
          here.bias_mean_mm + std::sqrt(here.bias_variance_mm2) * normal_place(evenly_filling(samples.size()));
      samples.push_back({weight, posterior.drag_lengths_mm[cell / posterior.ln_stiffness.size()],
                         std::exp(posterior.ln_stiffness[cell % posterior.ln_stiffness.size()]), bias});
    }
  }
  return samples;
}

}  // namespace

DragFit summary_of(const DragPosterior& posterior, const DragFitSettings& settings) {
  const std::size_t drags = posterior.drag_lengths_mm.size();
  const std::size_t stiffnesses = posterior.ln_stiffness.size();
  std::vector<double> drag_mass(drags, 0.0);
  std::vector<double> stiffness_mass(stiffnesses, 0.0);
  for (std::size_t i = 0; i < drags; ++i) {
    for (std::size_t k = 0; k < stiffnesses; ++k) {
      drag_mass[i] += posterior.at(i, k).mass;
      stiffness_mass[k] += posterior.at(i, k).mass;
    }
  }
  DragFit fit;
  fit.drag_length_mm = estimate_of(posterior.drag_lengths_mm, drag_mass, settings.credible);
  fit.drag_length_mm.prior_sd =
      (posterior.drag_lengths_mm.back() - posterior.drag_lengths_mm.front()) / std::sqrt(12.0);
  fit.ln_stiffness = estimate_of(posterior.ln_stiffness, stiffness_mass, settings.credible);
  fit.ln_stiffness.prior_sd = settings.stiffness_sd;
  fit.bias_mm = bias_estimate(posterior, settings);
  fit.correlation = correlation_of(posterior, fit);
  fit.residual = posterior.residual;
  fit.knows_stiffness = posterior.knows_stiffness;
  fit.samples = samples_of(posterior, static_cast<std::size_t>(settings.samples));
  return fit;
}

}  // namespace incise
