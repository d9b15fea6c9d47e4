#include "planning/margin_risk.hpp"

#include <incise/core/random.hpp>
#include <incise/evaluation/statistics.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <compare>

namespace incise {
namespace {

struct WeightedValue {
  double value = 0.0;
  double weight = 0.0;
  auto operator<=>(const WeightedValue&) const = default;
};

double mean_of(const std::vector<WeightedValue>& values) {
  double sum = 0.0, weights = 0.0;
  for (const WeightedValue& one : values) {
    sum += one.weight * one.value;
    weights += one.weight;
  }
  return sum / weights;
}

/// Interval that contains a share of the weight, with equal weight on either side of it. @pre ascending, not empty.
Interval middle_of(const std::vector<WeightedValue>& values, double share) {
  double weights = 0.0;
  for (const WeightedValue& one : values) weights += one.weight;
  const auto below = [&](double part) {
    double sum = 0.0;
    for (const WeightedValue& one : values) {
      sum += one.weight;
      if (sum >= part * weights) return one.value;
    }
    return values.back().value;
  };
  return {below(0.5 * (1.0 - share)), below(0.5 * (1.0 + share))};
}

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

MarginRisk::MarginRisk(const CutResidual& residual, const RobustSettings& settings) {
  least_error_ = settings.region.close_margin_mm + settings.kerf_allowance_mm - settings.target_mm;
  const auto degrees = static_cast<double>(residual.degrees);
  const double widening = residual.degrees > 0 ? degrees / (degrees - 2.0) : 1.0;
  sd_ = (widening * residual.covariance_mm2.diagonal()).cwiseSqrt();
  // A root that also exists for a covariance of less than full rank.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(residual.covariance_mm2);
  const Eigen::MatrixXd root = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Random random(settings.seed);
  residuals_.resize(residual.covariance_mm2.rows(), settings.samples);
  for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
    for (Eigen::Index i = 0; i < residuals_.rows(); ++i) residuals_(i, k) = random.normal();
  }
  residuals_ = root * residuals_;
  if (residual.degrees == 0) return;
  for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
    double squares = 0.0;
    for (std::size_t i = 0; i < residual.degrees; ++i) squares += std::pow(random.normal(), 2);
    residuals_.col(k) *= std::sqrt(degrees / squares);
  }
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

PathRisk MarginRisk::of(const std::vector<ScenarioErrors>& scenarios) const {
  PathRisk risk;
  risk.p_close_margin = p_close(scenarios);
  std::vector<WeightedValue> means;
  for (const ScenarioErrors& scenario : scenarios) {
    for (Eigen::Index k = 0; k < residuals_.cols(); ++k)
      means.push_back({(scenario.error_mm + residuals_.col(k)).cwiseAbs().mean(), scenario.weight});
  }
  risk.expected_abs_error_mm = mean_of(means);
  std::sort(means.begin(), means.end());
  risk.abs_error_80 = middle_of(means, 0.80);
  risk.abs_error_95 = middle_of(means, 0.95);
  return risk;
}

CutGain MarginRisk::gain(const std::vector<ScenarioErrors>& first, const std::vector<ScenarioErrors>& second) const {
  CutGain gain;
  std::vector<WeightedValue> won;
  double weights = 0.0;
  for (std::size_t s = 0; s < first.size(); ++s) {
    weights += first[s].weight;
    gain.move_mm += first[s].weight * (second[s].error_mm - first[s].error_mm).mean();
    for (Eigen::Index k = 0; k < residuals_.cols(); ++k) {
      const double before = (first[s].error_mm + residuals_.col(k)).cwiseAbs().mean();
      won.push_back({before - (second[s].error_mm + residuals_.col(k)).cwiseAbs().mean(), first[s].weight});
    }
  }
  gain.move_mm /= weights;
  gain.mean_mm = mean_of(won);
  double squares = 0.0, worse = 0.0;
  for (const WeightedValue& one : won) {
    squares += one.weight * one.value * one.value;
    worse += one.value < 0.0 ? one.weight : 0.0;
  }
  const double all = weights * static_cast<double>(residuals_.cols());
  gain.p_worse = worse / all;
  gain.sd_mm = std::sqrt(std::max(0.0, squares / all - gain.mean_mm * gain.mean_mm));
  std::sort(won.begin(), won.end());
  gain.interval_80 = middle_of(won, 0.80);
  gain.interval_95 = middle_of(won, 0.95);
  return gain;
}

}  // namespace incise
