#pragma once

#include "planning/path_course.hpp"

#include <Eigen/Core>

namespace incise {

/// How the cut follows the tool: held tissue is dragged along, so that a place of the cut answers to the tool's path
/// from there on, blurred. A waypoint's move spreads over its neighbours: the error at arc length s changes by the
/// average of the moves with Gaussian weights about s + shift.
class TissueResponse {
 public:
  /// @param shift_mm  by how much a place answers to what lies farther on; @param spread_mm  standard deviation of the
  /// weights, >= 0; 0: every waypoint answers to itself alone.
  TissueResponse(const PathCourse& course, double shift_mm, double spread_mm);

  /// Moves that answer to `error_mm`: those whose response comes nearest to its negative, the less exactly the finer
  /// the detail, as what tissue blurs away can only be undone by larger and larger moves. Where errors are alike all
  /// round, the move is just their negative.
  [[nodiscard]] std::vector<double> answer(const std::vector<double>& error_mm) const;
  /// By how much the error at the waypoint of each row changes with the move of the waypoint of each column.
  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return response_; }

 private:
  Eigen::MatrixXd response_;
};

}  // namespace incise
