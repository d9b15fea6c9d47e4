#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/cloud_surface.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/planning/plan_path.hpp>

#include <filesystem>
#include <optional>

namespace incise {

/// How a simulated path is projected onto the measured tissue. Defaults are the paper's (II-D.2).
struct ProjectSettings {
  PathKind kind = PathKind::Incise;
  double mark_depth_mm = 1.0;
  double mark_speed_mm_s = 2.0;
  int mark_waypoints = 96;
  std::optional<double> incise_depth_mm = std::nullopt;
  std::optional<double> incise_speed_mm_s = std::nullopt;
  double max_gap_mm = 2.0;
  double smoothing_mm = 10.0;
  double max_shift_mm = 5.0;
  AxisMode axis_mode = AxisMode::Approach;
};
/// Range of depth, mm, and speed, mm/s, of a projected path: above 0, and far beyond what an incision needs.
inline constexpr Range kLaidDepthMm{0.0, 50.0, true};
inline constexpr Range kLaidSpeedMmS{0.0, 50.0, true};
inline void describe(Visitor& v, ProjectSettings& s) {
  v("kind", s.kind, "A mark along the tumour edge, or the incision.");
  v({"mark_depth_mm", "Depth of a marking path below the surface (the paper's inferior offset).", "mm"},
    s.mark_depth_mm, kLaidDepthMm);
  v({"mark_speed_mm_s", "Speed along a marking path.", "mm/s"}, s.mark_speed_mm_s, kLaidSpeedMmS);
  v("mark_waypoints", s.mark_waypoints, "Number of waypoints of a marking path along the tumour edge.", {8.0, 2000.0});
  v({"incise_depth_mm", "Depth of an incision; absent: that of the path.", "mm"}, s.incise_depth_mm, kLaidDepthMm);
  v({"incise_speed_mm_s", "Speed of an incision; absent: that of the path.", "mm/s"}, s.incise_speed_mm_s,
    kLaidSpeedMmS);
  v({"max_gap_mm", "Greatest distance from a waypoint to the nearest measured point, in the picture.", "mm"},
    s.max_gap_mm, kNotNegative);
  v({"smoothing_mm", "Radius over which the shift onto the surface is averaged; 0: each point is shifted by itself.",
     "mm"},
    s.smoothing_mm, {0.0, 100.0});
  v({"max_shift_mm", "Greatest shift of a point onto the surface, along the approach.", "mm"}, s.max_shift_mm,
    kNotNegative);
  v("tool_axis", s.axis_mode, "How the tool is held: as in the path, or against the measured surface's normal.");
}

/// Surface of the measured tissue: a cloud or a mesh of triangles, in the robot's frame, seen along an approach.
class MeasuredSurface {
 public:
  /// A mesh without triangles is a cloud. @throws InvalidArgument as CloudSurface and SurfaceQuery.
  MeasuredSurface(const TriMesh& surface, const Vec3& approach);
  [[nodiscard]] const Vec3& approach() const { return approach_; }
  /// Whether the surface is a cloud of noisy points; otherwise a mesh, whose triangles are taken as exact.
  [[nodiscard]] bool is_cloud() const {
    return cloud_.has_value();
  }
  /// Returns the surface seen at p along the approach; nullopt if none is seen. A mesh has no gaps where it has
  /// triangles.
  [[nodiscard]] std::optional<CloudPlace> at(const Vec3& p) const;

 private:
  Vec3 approach_;
  std::optional<CloudSurface> cloud_;
  std::optional<SurfaceQuery> mesh_;
};

/// A path in the robot's frame, and how well the measured points support it.
struct ProjectedPath {
  ToolPath path;
  double max_gap_mm = 0.0;      ///< greatest distance of a point of path or edge from a measured point, in the picture
  double max_shift_mm = 0.0;    ///< greatest move of a point onto the surface under it, along the approach
  double mean_shift_mm = 0.0;   ///< signed: positive = the measured surface lies above the simulated one
  double shift_noise_mm = 0.0;  ///< rms deviation of the shifts from their local averages; 0 for a mesh
  std::size_t bridged = 0;      ///< points more than 0.5 mm from the nearest measured point
};

/// Returns the mean of the waypoints' axes after a similarity: the unit direction, robot's frame, in which a path is
/// projected.
/// @throws InvalidArgument without waypoints, for a T that is not a similarity, or if the axes point to different
/// sides.
[[nodiscard]] Vec3 approach_of(const ToolPath& path, const Mat4& T_robot_sim);

/// Returns the map p -> center + (p - center) / scale, robot's frame. It corrects a camera whose lengths are all
/// `scale` times too long about `center`. Applied after T_robot_sim (whose scale is `scale`), it gives the rigid
/// transform of a simulation at true size; applied to the measured points, it gives the tissue at true size.
/// @throws InvalidArgument unless scale > 0 and both are finite.
[[nodiscard]] Mat4 at_true_size(double scale, const Vec3& center_mm);

/// Transforms a path and its tumour edge by a similarity and projects them along the approach onto the measured
/// surface. The simulation determines the shape, the measurement the position. On a cloud, the shift of a point onto
/// the surface is therefore a smooth function of its place (a local plane in the picture, weights (1 - d²/r²)²), which
/// averages the cloud's noise over more than the patch under each point. On a mesh, each point lies on the surface
/// under it. A marking path follows the tumour edge, an incision the path. Depth and speed are real lengths and are not
/// scaled.
/// @param path         frame sim_stretched; for a marking path with a tumour edge.
/// @param T_robot_sim  rotation, one positive scale and a shift, mm.
/// @param name         name of the surface in messages.
/// @throws InvalidArgument with every violation of the settings, for another frame, a missing edge or a T that is not a
/// similarity; DataError naming the first point that misses the surface, lies beyond its rim, in too large a gap, or
/// too far above or below it, or whose shift differs by more than 1 mm from its local average.
[[nodiscard]] ProjectedPath project_path(const ToolPath& path, const Mat4& T_robot_sim, const MeasuredSurface& surface,
                                         const ProjectSettings& settings, const std::filesystem::path& name);

}  // namespace incise
