#pragma once

#include <incise/geometry/types.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace incise {

/// A tet as the four half spaces a + b z >= 0 along each line of sight: its barycentric coordinates.
class SightLines {
 public:
  explicit SightLines(const std::array<Vec3, 4>& corners) {
    Eigen::Matrix4d homogeneous;
    for (Eigen::Index c = 0; c < 4; ++c) homogeneous.col(c) << corners[static_cast<std::size_t>(c)], 1.0;
    // The inverse has a meaning only if the tet has a volume; a flat tet has no extent along a line of sight.
    const double size = (homogeneous.topRows<3>().rightCols<3>().colwise() - homogeneous.col(0).head<3>()).norm();
    is_flat_ = std::abs(homogeneous.determinant()) <= 1e-12 * size * size * size;
    if (!is_flat_) barycentric_ = homogeneous.inverse();
  }

  /// The part of the line of sight through (x, y) that lies within the tet and between two heights, mm; empty (high <
  /// low) if there is none.
  struct Span {
    double low = 0.0;
    double high = -1.0;
  };
  [[nodiscard]] Span within(const Vec2& p, double low, double high) const {
    if (is_flat_) return {};
    for (Eigen::Index c = 0; c < 4; ++c) {
      const double a = barycentric_(c, 0) * p.x() + barycentric_(c, 1) * p.y() + barycentric_(c, 3);
      const double b = barycentric_(c, 2);
      if (b > 0.0) {
        low = std::max(low, -a / b);
      } else if (b < 0.0) {
        high = std::min(high, -a / b);
      } else if (a < 0.0) {
        return {};
      }
    }
    return {low, high};
  }
  /// Length of that part, mm.
  [[nodiscard]] double length(const Vec2& p, double low, double high) const {
    const Span span = within(p, low, high);
    return std::max(0.0, span.high - span.low);
  }

 private:
  Eigen::Matrix4d barycentric_ = Eigen::Matrix4d::Zero();
  bool is_flat_ = false;
};

}  // namespace incise
