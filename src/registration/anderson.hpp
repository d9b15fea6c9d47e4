#pragma once

#include <Eigen/Core>
#include <deque>

namespace incise {

/// Anderson's acceleration of a fixed-point iteration x <- F(x) in a few unknowns: the next x is the combination of the
/// last steps' images whose combined step is least. A step that grows makes it forget. Source: [WalkerNi2011],
/// algorithm AA.
class Anderson {
 public:
  using Vector = Eigen::Matrix<double, 8, 1>;

  /// @param depth  steps that are remembered.
  explicit Anderson(std::size_t depth = 5) : depth_(depth) {}

  void forget();

  /// Where to go on after F took x to `image`.
  [[nodiscard]] Vector next(const Vector& x, const Vector& image);

 private:
  std::size_t depth_;
  std::deque<Vector> step_changes_;
  std::deque<Vector> image_changes_;
  Vector last_step_ = Vector::Zero();
  Vector last_image_ = Vector::Zero();
  bool has_last_ = false;
};

}  // namespace incise
