#pragma once

#include "planning/path_course.hpp"

#include <incise/planning/robust_compensation.hpp>

#include <Eigen/Core>

namespace incise {

/// A scenario's errors at the waypoints, its bias added.
struct ScenarioErrors {
  double weight = 0.0;
  Eigen::VectorXd error_mm;
};

/// Probabilities of what real cuts leave, with a residual that is correlated along the path.
class MarginRisk {
 public:
  MarginRisk(const PathCourse& course, const RobustSettings& settings);

  /// That anywhere along the path less tissue is left than the close margin; over the scenarios, by their weights.
  [[nodiscard]] double p_close(const std::vector<ScenarioErrors>& scenarios) const;
  /// E |error| over scenarios, residual and waypoints.
  [[nodiscard]] double expected_abs_error(const std::vector<ScenarioErrors>& scenarios) const;
  /// What the second path wins over the first, scenario by scenario. @pre lists of one length and order, not empty.
  [[nodiscard]] CutGain gain(const std::vector<ScenarioErrors>& first, const std::vector<ScenarioErrors>& second) const;
  /// Standard deviation of the error at one place, about its scenario's.
  [[nodiscard]] double sd_mm() const { return sd_; }
  /// The signed error at which just the close margin is left.
  [[nodiscard]] double least_error_mm() const { return least_error_; }

 private:
  double sd_ = 0.0;
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
