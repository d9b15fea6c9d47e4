#pragma once

#include <incise/geometry/types.hpp>

#include <algorithm>
#include <limits>

namespace incise {

/// Returns the barycentric coordinates of the point of triangle (a, b, c) nearest to p. A flat triangle counts as its
/// edges.
inline Vec3 nearest_barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  if (squared > 0.0) {
    const double u = (c - b).cross(p - b).dot(normal) / squared;
    const double v = (a - c).cross(p - c).dot(normal) / squared;
    const double w = 1.0 - u - v;
    if (u >= 0.0 && v >= 0.0 && w >= 0.0) return {u, v, w};
  }
  const std::array<const Vec3*, 3> corners{&a, &b, &c};
  Vec3 best = Vec3::UnitX();
  double best_squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Vec3 along = *corners[j] - *corners[i];
    const double length_squared = along.squaredNorm();
    const double t = length_squared > 0.0 ? std::clamp((p - *corners[i]).dot(along) / length_squared, 0.0, 1.0) : 0.0;
    const double distance_squared = (*corners[i] + t * along - p).squaredNorm();
    if (distance_squared < best_squared) {
      best_squared = distance_squared;
      best.setZero();
      best[static_cast<Eigen::Index>(i)] = 1.0 - t;
      best[static_cast<Eigen::Index>(j)] += t;
    }
  }
  return best;
}

}  // namespace incise
