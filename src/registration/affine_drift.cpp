#include "registration/gauss_field.hpp"
#include "registration/matching.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace incise {
namespace {

struct AffineSums {
  double count = 0.0;
  Vec3 target = Vec3::Zero();
  Vec3 source = Vec3::Zero();
  Mat3 cross = Mat3::Zero();   // Σ P x yᵀ
  Mat3 spread = Mat3::Zero();  // Σ P y yᵀ
  double target_squares = 0.0;
};

/// Every source point gets its share P1 and the sum of the targets that it holds, which is what an affine M-step needs.
AffineSums match_affinely(const Points& source, const Points& target, const AffineDrift& drift, double sigma,
                          const DriftSettings& settings, Workers& workers) {
  Points placed(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) placed[i] = drift.linear * source[i] + drift.translation_mm;
  const double noise = background(sigma, settings.outlier_weight, settings.dimensions,
                                  static_cast<double>(source.size()), static_cast<double>(target.size()));
  const std::vector<GaussSum> near = GaussField(placed, {}, sigma).at(target, workers);
  std::vector<double> shares(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    const double all = near[i].weight + noise;
    shares[i] = all > 0.0 ? 1.0 / all : 0.0;
  }
  const std::vector<GaussSum> held = GaussField(target, shares, sigma).at(placed, workers);
  AffineSums sums;
  for (std::size_t i = 0; i < source.size(); ++i) {
    sums.count += held[i].weight;
    sums.target += held[i].first;
    sums.source += held[i].weight * source[i];
    sums.cross += held[i].first * source[i].transpose();
    sums.spread += held[i].weight * source[i] * source[i].transpose();
    sums.target_squares += held[i].second;
  }
  return sums;
}

}  // namespace

AffineDrift affine_drift(std::span<const Vec3> source, std::span<const Vec3> target, const DriftSettings& settings,
                         Workers& workers, Monitor& monitor) {
  const std::vector<std::string> problems = validate(settings);
  INCISE_REQUIRE(problems.empty(), problems.front());
  INCISE_REQUIRE(!source.empty() && !target.empty(), "expected at least 1 point in each cloud");
  const Measure source_measure = measure_of(source);
  const Measure target_measure = measure_of(target);
  INCISE_REQUIRE(source_measure.center.allFinite() && target_measure.center.allFinite(), "expected finite points");
  AffineDrift drift;
  const Vec3& widths = source_measure.variances;
  if (is_line(widths) || is_line(target_measure.variances) ||
      (settings.dimensions == 3 && widths[0] < 1e-12 * widths[2])) {
    drift.outcome = DriftOutcome::Degenerate;
    return drift;
  }
  const double length = target_measure.radius;
  const Points y = normalised(source, source_measure.center, length);
  const Points x = normalised(target, target_measure.center, length);
  drift.translation_mm = (source_measure.center - target_measure.center) / length;
  double sigma =
      std::sqrt((measure_of(y).variances.sum() + 1.0 + drift.translation_mm.squaredNorm()) / settings.dimensions);
  while (drift.iterations < settings.max_iterations && drift.outcome != DriftOutcome::Cancelled) {
    if (monitor.is_cancelled()) {
      drift.outcome = DriftOutcome::Cancelled;
      break;
    }
    const AffineSums sums = match_affinely(y, x, drift, sigma, settings, workers);
    const Vec3 x_mean = sums.target / sums.count;
    const Vec3 y_mean = sums.source / sums.count;
    const Mat3 cross = sums.cross - sums.count * x_mean * y_mean.transpose();
    Mat3 spread = sums.spread - sums.count * y_mean * y_mean.transpose();
    // A drawing says nothing about the third axis: it stays what it is.
    if (settings.dimensions == 2) spread(2, 2) = 1.0;
    if (!(sums.count > 0.0) || !(spread.determinant() > 0.0)) {
      drift.outcome = DriftOutcome::Degenerate;
      break;
    }
    Mat3 numerator = cross;
    if (settings.dimensions == 2) numerator(2, 2) = 1.0;
    const Mat3 linear = numerator * spread.inverse();
    const Vec3 translation = x_mean - linear * y_mean;
    const double step = (linear - drift.linear).norm() + (translation - drift.translation_mm).norm();
    drift.linear = linear;
    drift.translation_mm = translation;
    Mat3 fitted = cross * linear.transpose();
    const double flat = settings.dimensions == 2 ? fitted(0, 0) + fitted(1, 1) : fitted.trace();
    const double misfit = sums.target_squares - sums.count * x_mean.squaredNorm() - flat;
    const double new_sigma = std::sqrt(std::max(0.0, misfit) / (sums.count * settings.dimensions));
    ++drift.iterations;
    const bool is_still = step < 0.1 * settings.tolerance && std::abs(new_sigma - sigma) < 1e-4 * sigma;
    sigma = new_sigma;
    if (is_still || sigma < kLeastSigma) {
      drift.outcome = DriftOutcome::Converged;
      break;
    }
  }
  drift.sigma_mm = sigma * length;
  drift.translation_mm = length * drift.translation_mm + target_measure.center - drift.linear * source_measure.center;
  return drift;
}

}  // namespace incise
