#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace incise {

// Anderson's acceleration, type II, of a fixed-point iteration x -> F(x) = x + f(x): what earlier points tell about how
// f changes with x says where to go beside the plain step. Source: [WalkerNi2011], algorithm AA.

/// The combination of earlier changes of f that comes nearest to f: one weight for each column of `changes`.
/// @param noise  rms noise of the entries of f, >= 0: changes within it are damped (Tikhonov). nullopt: plain least
/// squares.
template <int Rows>
[[nodiscard]] Eigen::VectorXd anderson_weights(const Eigen::Matrix<double, Rows, Eigen::Dynamic>& changes,
                                               const Eigen::Matrix<double, Rows, 1>& f, std::optional<double> noise) {
  if (!noise) return changes.colPivHouseholderQr().solve(f);
  // Each column's own noise is what a change of f that says nothing would look like.
  Eigen::MatrixXd normal = changes.transpose() * changes;
  normal.diagonal().array() += 2.0 * *noise * *noise * static_cast<double>(f.size()) + 1e-12 * normal.trace();
  return normal.ldlt().solve(changes.transpose() * f);
}

/// One point of an iteration.
struct IterationPoint {
  std::vector<double> x;
  std::vector<double> f;
};

/// Where to go from `base`: the plain step base.x + base.f, corrected by the other points.
/// @param earlier  any number of other points; none: the plain step.  @param noise  as above.
[[nodiscard]] std::vector<double> accelerated_step(const IterationPoint& base, std::span<const IterationPoint> earlier,
                                                   double noise);

/// An iteration in a few unknowns that is followed step by step, without noise: the next x is the combination of the
/// last steps' images whose combined step is least. A step that grows makes it forget.
template <int Unknowns>
class Anderson {
 public:
  using Vector = Eigen::Matrix<double, Unknowns, 1>;

  /// @param depth  steps that are remembered.
  explicit Anderson(std::size_t depth = 5) : depth_(depth) {}

  void forget() {
    step_changes_.clear();
    image_changes_.clear();
    has_last_ = false;
  }

  /// Where to go on after F took x to `image`.
  [[nodiscard]] Vector next(const Vector& x, const Vector& image) {
    const Vector step = image - x;
    if (has_last_ && step.norm() > 1.5 * last_step_.norm())
      forget();  // the combination has misled: begin again from a plain step
    if (has_last_) {
      step_changes_.push_back(step - last_step_);
      image_changes_.push_back(image - last_image_);
      if (step_changes_.size() > depth_) {
        step_changes_.pop_front();
        image_changes_.pop_front();
      }
    }
    last_step_ = step;
    last_image_ = image;
    has_last_ = true;
    if (step_changes_.empty()) return image;
    const auto depth = static_cast<Eigen::Index>(step_changes_.size());
    Eigen::Matrix<double, Unknowns, Eigen::Dynamic> changes(Unknowns, depth);
    for (Eigen::Index k = 0; k < depth; ++k) changes.col(k) = step_changes_[static_cast<std::size_t>(k)];
    const Eigen::VectorXd weights = anderson_weights<Unknowns>(changes, step, std::nullopt);
    Vector result = image;
    for (Eigen::Index k = 0; k < depth; ++k) result -= weights[k] * image_changes_[static_cast<std::size_t>(k)];
    return result.allFinite() ? result : image;
  }

 private:
  std::size_t depth_;
  std::deque<Vector> step_changes_;
  std::deque<Vector> image_changes_;
  Vector last_step_ = Vector::Zero();
  Vector last_image_ = Vector::Zero();
  bool has_last_ = false;
};

}  // namespace incise
