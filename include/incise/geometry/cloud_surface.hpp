#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <optional>
#include <span>

namespace incise {

struct CloudSurfaceSettings {
  double radius_mm = 2.5;     ///< about a place, of the points that are fitted, > 0; doubled while they are too few
  double max_reach_mm = 6.0;  ///< largest such radius, >= radius_mm
};

/// The surface of a measured cloud at one place of its view.
struct CloudPlace {
  Vec3 position_mm = Vec3::Zero();
  Vec3 normal = Vec3::Zero();    ///< unit, towards the observer
  double gap_mm = 0.0;           ///< distance in the picture plane to the nearest measured point
  bool is_extrapolated = false;  ///< no measured points on one side within max_reach_mm: beyond the rim
};

/// A cloud of points, seen along a direction, as a surface. At every place, a quadratic is fitted to the points around
/// it (weights (1 - d²/r²)², one round of rejection beyond 3 standard deviations), which averages noise out. The
/// surface has one height at every place: remove points under an overhang first. Build O(n log n), query O(log n +
/// points in reach). Source: moving least squares, Levin 1998.
class CloudSurface {
 public:
  /// @param points  n x 3, mm.  @param approach  direction of sight, in the same frame; not zero, need not be unit.
  /// @throws InvalidArgument for fewer than 12 points, points that are not finite, a cloud 5 m wide or wider, or
  /// settings out of range.
  CloudSurface(std::span<const Vec3> points, const Vec3& approach, const CloudSurfaceSettings& settings = {});

  [[nodiscard]] const ViewFrame& frame() const { return frame_; }
  [[nodiscard]] Vec3 approach() const { return -frame_.z; }
  /// Returns the surface at a place of the view; nullopt where fewer than 12 points lie within max_reach_mm.
  /// @param place  (x, y) in view coordinates, mm.
  [[nodiscard]] std::optional<CloudPlace> at(const Vec2& place) const;
  /// Returns the surface over a box of the view as a closed body for planning. Its top is the cloud wherever that is
  /// measured (no gap above `max_gap_mm`, not beyond the rim). Its bottom, which is not measured, lies `depth_mm` below
  /// the top, along the approach. The mesh is empty where nothing is measured.
  /// @param low, high  corners of the box in view coordinates, mm.  @param step_mm  spacing of the top's vertices, > 0.
  /// @throws InvalidArgument for an empty box, a step or depth that is not above 0, or 4e6 cells or more.
  [[nodiscard]] TriMesh body(const Vec2& low, const Vec2& high, double step_mm, double max_gap_mm,
                             double depth_mm) const;

 private:
  ViewFrame frame_;
  CloudSurfaceSettings settings_;
  Points in_view_;
  NeighbourSearch in_picture_;  ///< on the points projected into the picture plane
};

}  // namespace incise
