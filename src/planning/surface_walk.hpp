#pragma once

#include <incise/planning/plan_path.hpp>

#include <string>

namespace incise {

/// Formats a point for a message: "(1.00, -2.50, 3.00)".
[[nodiscard]] std::string in_words(const Vec3& p);

/// The surface as a picture along the approach: places are (x, y) of the view, each showing the topmost point.
class SurfaceView {
 public:
  SurfaceView(const SurfaceQuery& surface, const Vec3& approach) : surface_(&surface), view_(view_along(approach)) {}

  [[nodiscard]] const ViewFrame& frame() const { return view_; }
  [[nodiscard]] Vec3 approach() const { return -view_.z; }
  [[nodiscard]] Vec2 place_of(const Vec3& p) const { return view_.to_view(p).head<2>(); }
  [[nodiscard]] std::optional<SurfacePoint> at(const Vec2& place) const;
  /// Returns whether the surface is seen all along a circle about a place (in 16 directions).
  [[nodiscard]] bool is_clear_of_rim(const Vec2& place, double radius_mm) const;
  /// Returns the unit normal averaged over 2 mm about a place, towards the observer; normals of single triangles would
  /// make the tool jitter.
  [[nodiscard]] Vec3 smooth_normal(const Vec2& place) const;
  /// Returns the direction of the tool at a place. @pre the place shows the surface.
  [[nodiscard]] Vec3 tool_axis(const Vec2& place, AxisMode mode) const;

 private:
  const SurfaceQuery* surface_;
  ViewFrame view_;
};

/// Names of things in check_path's messages: "where: field: found …".
struct PathCheckWords {
  std::string where = "path";
  std::string course_field = "waypoints";
  std::string depth_field = "depth_mm";
};
void check_path_as(const PathCheckWords& words, const ToolPath& path, const SurfaceQuery& surface, const Vec3& approach,
                   double rim_clearance_mm);

}  // namespace incise
