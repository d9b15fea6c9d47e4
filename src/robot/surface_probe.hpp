#pragma once

#include <incise/geometry/cloud_surface.hpp>
#include <incise/geometry/surface_query.hpp>

#include <optional>

namespace incise::robot_detail {

/// Asks a tissue surface in the robot's frame, of triangles or of points only, where it lies.
class SurfaceProbe {
 public:
  /// @pre at least one vertex
  explicit SurfaceProbe(const TriMesh& surface);

  /// How deep p lies below the surface along the tool's axis (a unit vector), mm. Of a cloud: below the surface that
  /// CloudSurface lays through it, seen along the axis, as where a path is laid down. Nothing where the axis does not
  /// meet the surface, or no measured point lies within 2 mm of the axis, or none on one side of it.
  [[nodiscard]] std::optional<double> depth_mm(const Vec3& p, const Vec3& axis);

  /// Distance of a segment from the surface, mm; of triangles to 0.03 mm for distances from 5 mm on.
  [[nodiscard]] double distance_mm(const Vec3& from, const Vec3& to) const;

 private:
  Points points_;
  std::optional<SurfaceQuery> triangles_;
  std::optional<CloudSurface> seen_;  ///< the points, seen along the axis that was asked for last
};

}  // namespace incise::robot_detail
