#include "robot/surface_probe.hpp"

#include <incise/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::robot_detail {
namespace {

constexpr double kFarthestPointMm =
    2.0;  // of the nearest measured point from the tool's axis, as for laying a path down
constexpr std::size_t kLeastPoints = 12;  // what a CloudSurface asks for
constexpr double kSameDirection = 1e-9;
constexpr double kStepMm = 1.0;  // at 5 mm distance half of it matters by 0.025 mm

}  // namespace

SurfaceProbe::SurfaceProbe(const TriMesh& surface) : points_(surface.vertices) {
  INCISE_REQUIRE(!points_.empty(), "expected a surface with points, found none");
  if (!surface.triangles.empty()) triangles_.emplace(surface);
}

std::optional<double> SurfaceProbe::depth_mm(const Vec3& p, const Vec3& axis) {
  if (triangles_) {
    const auto seen = triangles_->seen_at(p, axis);
    return seen ? std::optional(-seen->distance_mm) : std::nullopt;
  }
  if (points_.size() < kLeastPoints) return std::nullopt;
  if (!seen_ || (seen_->approach() - axis).norm() > kSameDirection) seen_.emplace(points_, axis);
  const std::optional<CloudPlace> place = seen_->at(seen_->frame().to_view(p).head<2>());
  if (!place || place->is_extrapolated || place->gap_mm > kFarthestPointMm) return std::nullopt;
  return (p - place->position_mm).dot(axis);
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
