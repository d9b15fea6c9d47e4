#include "imaging/ruler_ticks.hpp"

#include <incise/core/units.hpp>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace incise::imaging_detail {
namespace {

/// A polynomial c0 + c1 u + c2 u² + … fitted through values at u in [-1, 1].
struct Fit {
  Eigen::VectorXd c;
  Eigen::VectorXd error;   ///< standard error of each coefficient
  double deviation = 0.0;  ///< standard deviation of the residuals
};

Fit fit_polynomial(const Eigen::VectorXd& u, const Eigen::VectorXd& values, int degree) {
  Eigen::MatrixXd A(u.size(), degree + 1);
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    for (int k = 0; k <= degree; ++k) A(i, k) = std::pow(u(i), k);
  }
  const Eigen::MatrixXd inverse = (A.transpose() * A).ldlt().solve(Eigen::MatrixXd::Identity(degree + 1, degree + 1));
  Fit fit;
  fit.c = inverse * A.transpose() * values;
  fit.deviation = std::sqrt((values - A * fit.c).squaredNorm() / static_cast<double>(u.size() - degree - 1));
  fit.error = fit.deviation * inverse.diagonal().cwiseSqrt();
  return fit;
}

/// Fits to the ticks' positions along and across their row. If some ticks are longer, their middles are out of line,
/// but not their ends at the ruler's edge.
struct Row {
  Fit along;
  Fit across;
};

Row row_of(const Comb& comb, const Eigen::VectorXd& u, const Vec2& tick, double share_of_length) {
  const Vec2 normal(-tick.y(), tick.x());
  Eigen::VectorXd along(u.size()), across(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const Stroke& stroke = comb.ticks[static_cast<std::size_t>(i)];
    const Vec2 p = stroke.center + share_of_length * stroke.length * tick;
    along(i) = normal.dot(p);
    across(i) = tick.dot(p);
  }
  return {fit_polynomial(u, along, 3), fit_polynomial(u, across, 2)};
}

}  // namespace

RulerShape shape_of(const Comb& comb) {
  const auto n = static_cast<Eigen::Index>(comb.ticks.size());
  const double middle = 0.5 * (comb.numbers.front() + comb.numbers.back());
  const double half = comb.numbers.back() - middle;
  Eigen::VectorXd u(n);
  Vec2 tick = Vec2::Zero();
  const Vec2 first = comb.ticks.front().direction;
  const auto turned_like_first = [&](const Vec2& d) { return d.dot(first) < 0.0 ? Vec2(-d) : d; };
  for (Eigen::Index i = 0; i < n; ++i) {
    u(i) = (comb.numbers[static_cast<std::size_t>(i)] - middle) / half;
    tick += turned_like_first(comb.ticks[static_cast<std::size_t>(i)].direction);
  }
  tick.normalize();
  Eigen::VectorXd angle_deg(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec2 d = turned_like_first(comb.ticks[static_cast<std::size_t>(i)].direction);
    angle_deg(i) = units::deg_from_rad(std::atan2(tick.x() * d.y() - tick.y() * d.x(), tick.dot(d)));
  }
  Row row;
  double least = std::numeric_limits<double>::infinity();
  for (const double share : {-0.5, 0.0, 0.5}) {
    const Row candidate = row_of(comb, u, tick, share);
    if (candidate.across.deviation >= least) continue;
    least = candidate.across.deviation;
    row = candidate;
  }
  const double length = 2.0 * std::abs(row.along.c(1));
  const Fit angles = fit_polynomial(u, angle_deg, 1);
  // The parabola's slope in the middle gives the row's direction: if no tick is missing, it is that of a straight-line
  // fit.
  const double slope = row.across.c(1) / row.along.c(1);
  const double slope_error = row.across.error(1) / std::abs(row.along.c(1));
  RulerShape shape;
  shape.spacing_change = {4.0 * row.along.c(2) / row.along.c(1), 8.0 * row.along.error(2) / length};
  shape.convergence_deg = {2.0 * angles.c(1), 2.0 * angles.error(1)};
  shape.skew_deg = {units::deg_from_rad(std::atan(slope)),
                    std::hypot(units::deg_from_rad(slope_error), angles.error(0))};
  shape.end_stretch = {3.0 * row.along.c(3) / row.along.c(1), 6.0 * row.along.error(3) / length};
  shape.bow = {row.across.c(2) / length, row.across.error(2) / length};
  return shape;
}

}  // namespace incise::imaging_detail
