#pragma once

#include <incise/planning/robust_compensation.hpp>

#include <Eigen/Core>

namespace incise {

/// A scenario's errors at the waypoints, its bias added.
struct ScenarioErrors {
  double weight = 0.0;
  Eigen::VectorXd error_mm;
};

/// Probabilities of what real cuts leave, counted over residuals that are drawn about what is expected.
class MarginRisk {
 public:
  /// @pre as require_scenarios.
  MarginRisk(const CutResidual& residual, const RobustSettings& settings);

  /// That anywhere along the path less tissue is left than the close margin; over the scenarios, by their weights.
  [[nodiscard]] double p_close(const std::vector<ScenarioErrors>& scenarios) const;
  /// What is to be expected of a path; nothing is said of unmeasured scenarios.
  [[nodiscard]] PathRisk of(const std::vector<ScenarioErrors>& scenarios) const;
  /// What the second path wins over the first, scenario by scenario. @pre lists of one length and order, not empty.
  [[nodiscard]] CutGain gain(const std::vector<ScenarioErrors>& first, const std::vector<ScenarioErrors>& second) const;
  /// Standard deviation of the error at each waypoint, about what is expected.
  [[nodiscard]] const Eigen::VectorXd& sd_mm() const { return sd_; }
  /// The signed error at which just the close margin is left.
  [[nodiscard]] double least_error_mm() const { return least_error_; }

 private:
  Eigen::VectorXd sd_;
  double least_error_ = 0.0;
  Eigen::MatrixXd residuals_;  ///< waypoints x samples, mm; the same for every path
};

/// For a normal error of mean m and standard deviation sd: E|error| and its derivatives by m.
struct FoldedNormal {
  double value = 0.0, slope = 0.0, curvature = 0.0;
};
[[nodiscard]] FoldedNormal folded_normal(double mean, double sd);
/// E max(0, least − error), and its derivatives by the mean: by how much, on average, a margin falls short.
[[nodiscard]] FoldedNormal expected_shortfall(double mean, double sd, double least);

}  // namespace incise
