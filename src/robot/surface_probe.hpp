#pragma once

#include <incise/geometry/surface_query.hpp>

#include <optional>

namespace incise::robot_detail {

/// Asks a tissue surface in the robot's frame, of triangles or of points only, where it lies.
class SurfaceProbe {
 public:
  /// @pre at least one vertex
  explicit SurfaceProbe(const TriMesh& surface);

  /// How deep p lies below the surface along the tool's axis, mm. Of a cloud: below the plane through its points within
  /// 2 mm of the axis. Nothing where the axis does not meet the surface, or fewer than four points lie there.
  [[nodiscard]] std::optional<double> depth_mm(const Vec3& p, const Vec3& axis) const;

  /// Distance of a segment from the surface, mm; of triangles to 0.03 mm for distances from 5 mm on.
  [[nodiscard]] double distance_mm(const Vec3& from, const Vec3& to) const;

 private:
  Points points_;
  std::optional<SurfaceQuery> triangles_;
};

}  // namespace incise::robot_detail
