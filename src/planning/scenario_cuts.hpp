#pragma once

#include "planning/margin_risk.hpp"
#include "planning/path_course.hpp"
#include "planning/safe_moves.hpp"

#include <incise/planning/robust_compensation.hpp>

#include <Eigen/Core>

namespace incise {

/// A scenario, linear about a path that was cut: expected errors of real cuts along it, and their response to moves.
struct LinearScenario {
  std::size_t place = 0;  ///< index in the list of scenarios
  double weight = 0.0;    ///< as a share of all weights
  Eigen::VectorXd error_mm;
  Eigen::MatrixXd response;
};

[[nodiscard]] inline Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Returns the scenarios' errors after a move of the waypoints, mm.
[[nodiscard]] std::vector<ScenarioErrors> moved_errors(const std::vector<LinearScenario>& scenarios,
                                                       const Eigen::VectorXd& move);

/// Makes and measures cuts in every scenario, along paths beside an intended one.
class ScenarioCuts {
 public:
  struct Cut {
    MovablePath::Moved moved;
    std::vector<LinearScenario> scenarios;  ///< those that could be measured
    PathRisk risk;
  };

  /// @throws InvalidArgument as compensate_robust. The arguments outlive this object.
  ScenarioCuts(const ToolPath& intended, const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
               const MeasureScenarios& measure, const CutResidual& residual, const RobustSettings& settings);

  [[nodiscard]] Cut along_intended();
  [[nodiscard]] Cut along(MovablePath::Moved moved);
  [[nodiscard]] Cut along(const std::vector<double>& offset_mm) { return along(movable_.at(offset_mm)); }

  [[nodiscard]] const MovablePath& movable() const { return movable_; }
  [[nodiscard]] const MarginRisk& risk() const { return risk_; }
  [[nodiscard]] std::size_t simulations() const { return simulations_; }

 private:
  [[nodiscard]] LinearScenario linear(std::size_t place, const PathErrors& errors) const;

  const ToolPath& intended_;
  const std::vector<CutScenario>& scenarios_;
  const MeasureScenarios& measure_;
  const Eigen::VectorXd expected_residual_mm_;  ///< per waypoint
  const RobustSettings& settings_;
  const PathCourse course_;
  const MovablePath movable_;
  const MarginRisk risk_;
  double all_weights_ = 0.0;
  std::size_t simulations_ = 0;
};

/// @throws InvalidArgument or CaseError as compensate_robust.
void require_scenarios(const ToolPath& intended, const std::vector<double>& corrected_offset_mm,
                       const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
                       const CutResidual& residual, const RobustSettings& settings);

}  // namespace incise
