#pragma once

#include "planning/path_course.hpp"

#include <Eigen/Core>

namespace incise {

/// Response of the cut to moves of the tool's path. The tool drags held tissue along, so a place of the cut responds to
/// the path farther on, blurred. A waypoint's move spreads over its neighbours: the error at arc length s changes by
/// the average of the moves with Gaussian weights about s + shift.
class TissueResponse {
 public:
  /// @param shift_mm   how much farther on the path lies to which a place responds.
  /// @param spread_mm  standard deviation of the weights, >= 0; 0: every waypoint responds to itself alone.
  TissueResponse(const PathCourse& course, double shift_mm, double spread_mm);

  /// Returns moves that correct `error_mm`: their response comes nearest to its negative. The finer the detail, the
  /// less exact the match, because undoing the blur of fine detail takes ever larger moves. For an error that is the
  /// same all round, the move is its negative.
  [[nodiscard]] std::vector<double> answer(const std::vector<double>& error_mm) const;
  /// Change of the error at the waypoint of each row per move of the waypoint of each column.
  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return response_; }

 private:
  Eigen::MatrixXd response_;
};

}  // namespace incise
