#pragma once

#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/surface_query.hpp>

#include <optional>

namespace incise::robot_detail {

/// Measures distances from a tissue surface in the robot's frame, given as triangles or as points only.
class SurfaceProbe {
 public:
  /// @pre at least one vertex
  explicit SurfaceProbe(const TriMesh& surface);

  /// Returns the depth of p below the surface along the tool's axis (a unit vector), mm. In a cloud: below the plane
  /// through its points within 2 mm of the axis. If these are few or all on one side, as at the border of a hole, the
  /// radius grows up to 4 mm, until the standard deviation of the plane's height on the axis is at most 0.55 of a
  /// point's noise. Nothing if the axis does not meet the surface, if there is no such plane, or if no point lies
  /// within 2 mm of the axis.
  [[nodiscard]] std::optional<double> depth_mm(const Vec3& p, const Vec3& axis) const;

  /// Returns the distance of p from the nearest triangle, or from the nearest point of a cloud, mm.
  [[nodiscard]] double distance_mm(const Vec3& p) const;

 private:
  [[nodiscard]] std::optional<double> below_plane_mm(const Vec3& p, const Vec3& axis, double radius_mm) const;
  Points points_;
  NeighbourSearch cloud_;
  std::optional<SurfaceQuery> triangles_;
};

}  // namespace incise::robot_detail
