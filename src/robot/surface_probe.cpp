#include "robot/surface_probe.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::robot_detail {
namespace {

constexpr double kPlaneRadiusMm = 2.0;
constexpr double kBridgeRadiusMm = 4.0;   // on tissue with a radius of 25 mm a plane of this size lies 0.2 mm off
constexpr double kFarthestPointMm = 2.0;  // greatest distance of the nearest measured point from the axis
constexpr double kMostVariance =
    0.3;  // of the plane's height on the axis, divided by that of a point: four points round the axis give 0.25

}  // namespace

SurfaceProbe::SurfaceProbe(const TriMesh& surface) : points_(surface.vertices), cloud_(points_) {
  if (!surface.triangles.empty()) triangles_.emplace(surface);
}

std::optional<double> SurfaceProbe::depth_mm(const Vec3& p, const Vec3& axis) const {
  if (triangles_) {
    const auto seen = triangles_->seen_at(p, axis);
    return seen ? std::optional(-seen->distance_mm) : std::nullopt;
  }
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const Vec3& point : points_) nearest2 = std::min(nearest2, (point - p).cross(axis).squaredNorm());
  if (nearest2 > kFarthestPointMm * kFarthestPointMm) return std::nullopt;
  // At the border of a hole, with few points or all on one side, the plane is fitted to more and farther points.
  for (double radius = kPlaneRadiusMm; radius <= kBridgeRadiusMm; radius += 1.0)
    if (const std::optional<double> depth = below_plane_mm(p, axis, radius)) return depth;
  return std::nullopt;
}

std::optional<double> SurfaceProbe::below_plane_mm(const Vec3& p, const Vec3& axis, double radius_mm) const {
  // Least squares for the height over the two directions across the axis; its value on the axis is the depth.
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (const Vec3& point : points_) {
    const Vec3 away = point - p;
    const Vec3 row(1.0, u.dot(away), v.dot(away));
    if (row.tail<2>().squaredNorm() > radius_mm * radius_mm) continue;
    normal += row * row.transpose();
    right -= axis.dot(away) * row;
  }
  Eigen::FullPivLU<Mat3> solver(normal);
  solver.setThreshold(1e-6);
  if (!solver.isInvertible()) return std::nullopt;  // fewer than three points, or all on one line
  if (Vec3(solver.solve(Vec3::UnitX()))[0] > kMostVariance) return std::nullopt;
  return Vec3(solver.solve(right))[0];
}

double SurfaceProbe::distance_mm(const Vec3& p) const {
  return triangles_ ? triangles_->nearest(p).distance_mm : std::sqrt(cloud_.nearest(p).squared_mm2);
}

}  // namespace incise::robot_detail
