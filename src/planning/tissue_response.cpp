#include "planning/tissue_response.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace incise {
namespace {

/// Weight of the moves' detail against the remaining error: undoes a response of more than a third.
constexpr double kDetailWeight = 0.1;

}  // namespace

TissueResponse::TissueResponse(const PathCourse& course, double shift_mm, double spread_mm) {
  const auto n = static_cast<Eigen::Index>(course.waypoints());
  response_ = Eigen::MatrixXd::Identity(n, n);
  if (spread_mm <= 0.0) return;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto row = static_cast<std::size_t>(i);
      const auto column = static_cast<std::size_t>(j);
      const double apart = course.way(course.at(row) + shift_mm, course.at(column)) / spread_mm;
      response_(i, j) = std::exp(-0.5 * apart * apart) * course.share_mm(column);
    }
    response_.row(i) /= response_.row(i).sum();
  }
}

std::vector<double> TissueResponse::answer(const std::vector<double>& error_mm) const {
  const auto n = static_cast<Eigen::Index>(error_mm.size());
  const Eigen::Map<const Eigen::VectorXd> error(error_mm.data(), n);
  // Detail is the part of the moves that the response removes: 1 − |H|² of each wave, so none of a move that is the
  // same all round.
  const Eigen::MatrixXd seen = response_.transpose() * response_;
  const Eigen::MatrixXd system = (1.0 - kDetailWeight) * seen + kDetailWeight * Eigen::MatrixXd::Identity(n, n);
  std::vector<double> moves(error_mm.size());
  Eigen::Map<Eigen::VectorXd>(moves.data(), n) = -system.ldlt().solve(response_.transpose() * error);
  return moves;
}

}  // namespace incise
