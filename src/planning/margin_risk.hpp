#pragma once

#include <incise/planning/robust_compensation.hpp>

#include <Eigen/Core>

namespace incise {

/// Errors of a scenario at the waypoints, bias and expected residual added.
struct ScenarioErrors {
  double weight = 0.0;
  Eigen::VectorXd error_mm;
};

/// Risks of real cuts, counted over residuals drawn from their distribution.
class MarginRisk {
 public:
  /// @pre as require_scenarios.
  MarginRisk(const CutResidual& residual, const RobustSettings& settings);

  /// Returns the probability that somewhere along the path less tissue is left than the close margin, over the
  /// scenarios by their weights.
  [[nodiscard]] double p_close(const std::vector<ScenarioErrors>& scenarios) const;
  /// Returns the expected errors and risk of a path over measured scenarios; unmeasured_weight stays 0.
  [[nodiscard]] PathRisk of(const std::vector<ScenarioErrors>& scenarios) const;
  /// Returns the gain of the second path over the first, scenario by scenario. @pre lists of equal length and order,
  /// not empty.
  [[nodiscard]] CutGain gain(const std::vector<ScenarioErrors>& first, const std::vector<ScenarioErrors>& second) const;
  /// Standard deviation of the error at each waypoint, mm.
  [[nodiscard]] const Eigen::VectorXd& sd_mm() const { return sd_; }
  /// Signed error, mm, at which exactly the close margin is left.
  [[nodiscard]] double least_error_mm() const { return least_error_; }

 private:
  Eigen::VectorXd sd_;
  double least_error_ = 0.0;
  Eigen::MatrixXd residuals_;  ///< waypoints x samples, mm; the same for every path
};

/// E|error| of a normal error, and its first and second derivative by the mean.
struct FoldedNormal {
  double value = 0.0, slope = 0.0, curvature = 0.0;
};
[[nodiscard]] FoldedNormal folded_normal(double mean, double sd);
/// The same for E max(0, least − error): the mean amount by which a margin falls short.
[[nodiscard]] FoldedNormal expected_shortfall(double mean, double sd, double least);

}  // namespace incise
