#include "planning/margin_risk.hpp"

#include <incise/core/random.hpp>
#include <incise/evaluation/statistics.hpp>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise {
namespace {

constexpr double kJitter = 1e-9;  // keeps the covariance of waypoints that nearly coincide positive definite

}  // namespace

FoldedNormal folded_normal(double mean, double sd) {
  const double z = mean / sd;
  const double slope = 2.0 * normal_share_below(z) - 1.0;
  return {2.0 * sd * normal_density(z) + mean * slope, slope, 2.0 * normal_density(z) / sd};
}

FoldedNormal expected_shortfall(double mean, double sd, double least) {
  const double z = (least - mean) / sd;
  return {sd * normal_density(z) + (least - mean) * normal_share_below(z), -normal_share_below(z),
          normal_density(z) / sd};
}

MarginRisk::MarginRisk(const PathCourse& course, const RobustSettings& settings)
    : sd_(std::hypot(settings.residual_sd_mm, settings.common_sd_mm, settings.placement_sd_mm)) {
  least_error_ = settings.region.close_margin_mm + settings.kerf_allowance_mm - settings.target_mm;
  const auto n = static_cast<Eigen::Index>(course.waypoints());
  const double common = std::pow(settings.common_sd_mm, 2);
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double apart =
          std::abs(course.way(course.at(static_cast<std::size_t>(i)), course.at(static_cast<std::size_t>(j))));
      const double turn = 2.0 * std::numbers::pi * apart / course.length_mm();
      covariance(i, j) = std::pow(settings.residual_sd_mm, 2) * std::exp(-apart / settings.residual_length_mm) +
                         common + std::pow(settings.placement_sd_mm, 2) * std::cos(turn);
    }
  }
  covariance.diagonal().array() += kJitter * sd_ * sd_;
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  Random random(settings.seed);
  residuals_.resize(n, settings.samples);
  for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
    for (Eigen::Index i = 0; i < n; ++i) residuals_(i, k) = random.normal();
  }
  residuals_ = factor * residuals_;
}

double MarginRisk::p_close(const std::vector<ScenarioErrors>& scenarios) const {
  double sum = 0.0;
  double weights = 0.0;
  for (const ScenarioErrors& scenario : scenarios) {
    Eigen::Index close = 0;
    for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
      close += (scenario.error_mm + residuals_.col(k)).minCoeff() < least_error_ ? 1 : 0;
    }
    sum += scenario.weight * static_cast<double>(close) / static_cast<double>(residuals_.cols());
    weights += scenario.weight;
  }
  return sum / weights;
}

double MarginRisk::expected_abs_error(const std::vector<ScenarioErrors>& scenarios) const {
  double sum = 0.0;
  double weights = 0.0;
  for (const ScenarioErrors& scenario : scenarios) {
    double mean = 0.0;
    for (const double error : scenario.error_mm) mean += folded_normal(error, sd_).value;
    sum += scenario.weight * mean / static_cast<double>(scenario.error_mm.size());
    weights += scenario.weight;
  }
  return sum / weights;
}

CutGain MarginRisk::gain(const std::vector<ScenarioErrors>& first, const std::vector<ScenarioErrors>& second) const {
  CutGain gain;
  double weights = 0.0;
  double squares = 0.0;
  const double share = 1.0 / static_cast<double>(residuals_.cols());
  for (std::size_t s = 0; s < first.size(); ++s) {
    const double weight = share * first[s].weight;
    weights += first[s].weight;
    gain.move_mm += first[s].weight * (second[s].error_mm - first[s].error_mm).mean();
    for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
      const double before = (first[s].error_mm + residuals_.col(k)).cwiseAbs().mean();
      const double won = before - (second[s].error_mm + residuals_.col(k)).cwiseAbs().mean();
      gain.mean_mm += weight * won;
      squares += weight * won * won;
      gain.p_worse += won < 0.0 ? weight : 0.0;
    }
  }
  gain.mean_mm /= weights;
  gain.p_worse /= weights;
  gain.move_mm /= weights;
  gain.sd_mm = std::sqrt(std::max(0.0, squares / weights - gain.mean_mm * gain.mean_mm));
  return gain;
}

}  // namespace incise
