#include "robot/surface_probe.hpp"

#include <incise/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::robot_detail {
namespace {

constexpr double kPlaneRadiusMm = 2.0;
constexpr std::size_t kLeastPlanePoints = 4;
constexpr double kFarthestPointMm =
    2.0;  // of the nearest measured point from the tool's axis, as where a path is laid down
constexpr double kBridgeRadiusMm = 4.0;  // on tissue with a radius of 25 mm a plane of this size lies 0.16 mm off
constexpr std::size_t kLeastBridgePoints = 12;
constexpr double kStepMm = 1.0;  // at 5 mm distance half of it matters by 0.025 mm

}  // namespace

SurfaceProbe::SurfaceProbe(const TriMesh& surface) : points_(surface.vertices) {
  INCISE_REQUIRE(!points_.empty(), "expected a surface with points, found none");
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
  std::optional<double> depth = below_plane_mm(p, axis, kPlaneRadiusMm, kLeastPlanePoints);
  // At the border of a hole: the plane rests on more points, farther off.
  for (double radius = kPlaneRadiusMm + 1.0; !depth && radius <= kBridgeRadiusMm; radius += 1.0)
    depth = below_plane_mm(p, axis, radius, kLeastBridgePoints);
  return depth;
}

std::optional<double> SurfaceProbe::below_plane_mm(const Vec3& p, const Vec3& axis, double radius_mm,
                                                   std::size_t least_points) const {
  // Least squares: height against the two directions across the axis; the plane's height on the axis is wanted.
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  std::size_t count = 0;
  for (const Vec3& point : points_) {
    const Vec3 away = point - p;
    const Vec3 row(1.0, u.dot(away), v.dot(away));
    if (row.tail<2>().squaredNorm() > radius_mm * radius_mm) continue;
    normal += row * row.transpose();
    right -= axis.dot(away) * row;
    ++count;
  }
  if (count < least_points) return std::nullopt;
  const auto solver = normal.ldlt();
  if (solver.rcond() < 1e-6) return std::nullopt;  // points on one line
  return Vec3(solver.solve(right))[0];
}

double SurfaceProbe::distance_mm(const Vec3& from, const Vec3& to) const {
  double nearest = std::numeric_limits<double>::infinity();
  const Vec3 along = to - from;
  if (triangles_) {
    const int steps = std::max(1, static_cast<int>(std::ceil(along.norm() / kStepMm)));
    for (int i = 0; i <= steps; ++i) {
      const Vec3 at = from + along * (static_cast<double>(i) / steps);
      nearest = std::min(nearest, triangles_->nearest(at).distance_mm);
    }
    return nearest;
  }
  const double length2 = along.squaredNorm();
  for (const Vec3& point : points_) {
    const double t = length2 > 0.0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (point - from - t * along).squaredNorm());
  }
  return std::sqrt(nearest);
}

}  // namespace incise::robot_detail
