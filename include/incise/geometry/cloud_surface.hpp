#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

struct CloudSurfaceSettings {
  double radius_mm = 2.5;     ///< of the points that one place rests on, > 0; doubled where they are too few
  double max_reach_mm = 6.0;  ///< no farther than this, >= radius_mm
};

/// What a measured cloud shows at a place of its picture.
struct CloudPlace {
  Vec3 position_mm = Vec3::Zero();
  Vec3 normal = Vec3::Zero();    ///< unit, towards the observer
  double gap_mm = 0.0;           ///< in the picture, to the nearest measured point
  bool is_extrapolated = false;  ///< no measured points on one side: beyond the rim
};

/// A cloud of points seen along a direction, as a surface: at every place a quadratic is fitted to the points around
/// (weights (1 - d²/r²)², one round of rejection beyond 3 standard deviations), so that noise averages out.
/// One height at every place: what lies under an overhang must be cut off before. Build O(n log n), query O(log n) and
/// the points in reach. Source: moving least squares, Levin 1998.
class CloudSurface {
 public:
  /// @throws InvalidArgument for fewer than 12 points, points that are not finite, or settings out of range.
  CloudSurface(std::span<const Vec3> points, const Vec3& approach, const CloudSurfaceSettings& settings = {});

  [[nodiscard]] const ViewFrame& frame() const { return frame_; }
  [[nodiscard]] Vec3 approach() const { return -frame_.z; }
  /// @param place  (x, y) of the view.  @returns nullopt where fewer than 12 points lie within reach.
  [[nodiscard]] std::optional<CloudPlace> at(const Vec2& place) const;
  /// The surface over a box of the view as a closed body for planning: its top is the cloud wherever it is measured (no
  /// gap above `max_gap_mm`, not beyond the rim), its floor lies `depth_mm` below along the approach, for want of a
  /// measured one.
  /// @returns an empty mesh where nothing is measured.
  [[nodiscard]] TriMesh body(const Vec2& low, const Vec2& high, double step_mm, double max_gap_mm,
                             double depth_mm) const;

 private:
  [[nodiscard]] std::vector<std::size_t> within(const Vec2& place, double radius_mm) const;

  ViewFrame frame_;
  CloudSurfaceSettings settings_;
  Points in_view_;
  NeighbourSearch in_picture_;  ///< of the points with their heights left out
};

}  // namespace incise
