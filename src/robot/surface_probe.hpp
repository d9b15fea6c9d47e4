#pragma once

#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/surface_query.hpp>

#include <optional>

namespace incise::robot_detail {

/// Asks a tissue surface in the robot's frame, of triangles or of points only, where it lies.
class SurfaceProbe {
 public:
  /// @pre at least one vertex
  explicit SurfaceProbe(const TriMesh& surface);

  /// How deep p lies below the surface along the tool's axis (a unit vector), mm. Of a cloud: below the plane through
  /// its points within 2 mm of the axis, or at the border of a hole, where these are few or all on one side, within up
  /// to 4 mm: until its height on the axis varies by no more than 0.55 of a point's noise. Nothing where the axis does
  /// not meet the surface, where no such plane is found, or where the nearest point is more than 2 mm from the axis.
  [[nodiscard]] std::optional<double> depth_mm(const Vec3& p, const Vec3& axis) const;

  /// Distance of a point from the nearest triangle, or of a cloud from its nearest point, mm.
  [[nodiscard]] double distance_mm(const Vec3& p) const;

 private:
  [[nodiscard]] std::optional<double> below_plane_mm(const Vec3& p, const Vec3& axis, double radius_mm) const;
  Points points_;
  NeighbourSearch cloud_;
  std::optional<SurfaceQuery> triangles_;
};

}  // namespace incise::robot_detail
