#include "registration/anderson.hpp"

#include <Eigen/QR>

namespace incise {

void Anderson::forget() {
  step_changes_.clear();
  image_changes_.clear();
  has_last_ = false;
}

Anderson::Vector Anderson::next(const Vector& x, const Vector& image) {
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
  Eigen::Matrix<double, 8, Eigen::Dynamic> changes(8, depth);
  for (Eigen::Index k = 0; k < depth; ++k) changes.col(k) = step_changes_[static_cast<std::size_t>(k)];
  const Eigen::VectorXd weights = changes.colPivHouseholderQr().solve(step);
  Vector result = image;
  for (Eigen::Index k = 0; k < depth; ++k) result -= weights[k] * image_changes_[static_cast<std::size_t>(k)];
  return result.allFinite() ? result : image;
}

}  // namespace incise
