#include <incise/core/anderson.hpp>

namespace incise {

std::vector<double> accelerated_step(const IterationPoint& base, std::span<const IterationPoint> earlier,
                                     double noise) {
  using Vector = Eigen::VectorXd;
  const auto n = static_cast<Eigen::Index>(base.x.size());
  const auto m = static_cast<Eigen::Index>(earlier.size());
  const auto as_vector = [n](const std::vector<double>& values) { return Eigen::Map<const Vector>(values.data(), n); };
  Vector step = as_vector(base.f);
  if (m > 0) {
    Eigen::MatrixXd moved(n, m);
    Eigen::MatrixXd changed(n, m);
    for (Eigen::Index j = 0; j < m; ++j) {
      const IterationPoint& other = earlier[static_cast<std::size_t>(j)];
      moved.col(j) = as_vector(base.x) - as_vector(other.x);
      changed.col(j) = as_vector(base.f) - as_vector(other.f);
    }
    const Vector share = anderson_weights<Eigen::Dynamic>(changed, step, noise);
    step -= (moved + changed) * share;
  }
  std::vector<double> next(base.x.size());
  Eigen::Map<Vector>(next.data(), n) = as_vector(base.x) + step;
  return next;
}

}  // namespace incise
