#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace incise {

// Anderson acceleration, type II, of a fixed-point iteration x -> F(x) = x + f(x): corrects the plain step by the
// changes of f between earlier points. Source: [WalkerNi2011], algorithm AA.

/// Returns the combination of earlier changes of f that is nearest to f: one weight for each column of `changes`.
/// @param changes  n x m: differences of f between points.
/// @param f  n values.
/// @param noise  rms noise of the entries of f, >= 0: changes within it are damped (Tikhonov). nullopt: plain least
/// squares.
template <int Rows>
[[nodiscard]] Eigen::VectorXd anderson_weights(const Eigen::Matrix<double, Rows, Eigen::Dynamic>& changes,
                                               const Eigen::Matrix<double, Rows, 1>& f, std::optional<double> noise) {
  if (!noise) return changes.colPivHouseholderQr().solve(f);
  // A difference of two noisy values of f has this expected squared norm from the noise alone.
  Eigen::MatrixXd normal = changes.transpose() * changes;
  normal.diagonal().array() += 2.0 * *noise * *noise * static_cast<double>(f.size()) + 1e-12 * normal.trace();
  return normal.ldlt().solve(changes.transpose() * f);
}

/// One point of an iteration.
struct IterationPoint {
  std::vector<double> x;
  std::vector<double> f;
};

/// Returns the next x after `base`: the plain step base.x + base.f, corrected by the other points.
/// @param earlier  any number of other points, of the same size; none: the plain step.
/// @param noise  rms noise of the entries of f, >= 0.
[[nodiscard]] std::vector<double> accelerated_step(const IterationPoint& base, std::span<const IterationPoint> earlier,
                                                   double noise);

/// Accelerates an iteration in a few unknowns step by step, without noise. The next x combines the images of the last
/// steps with the weights that make the combined step least. If a step is more than 1.5 times as long as the last one,
/// the history is dropped.
template <int Unknowns>
class Anderson {
 public:
  using Vector = Eigen::Matrix<double, Unknowns, 1>;

  /// @param depth  number of changes between steps that are kept.
  explicit Anderson(std::size_t depth = 5) : depth_(depth) {}

  void forget() {
    step_changes_.clear();
    image_changes_.clear();
    has_last_ = false;
  }

  /// Returns the next x, given x and its image F(x).
  [[nodiscard]] Vector next(const Vector& x, const Vector& image) {
    const Vector step = image - x;
    if (has_last_ && step.norm() > 1.5 * last_step_.norm())
      forget();  // the combination misled: restart with a plain step
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
