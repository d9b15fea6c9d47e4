#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/names.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/types.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// The frame of a path's coordinates.
enum class PathFrame {
  SimRest,       ///< the undeformed mesh, mm, LPS
  SimStretched,  ///< the clamped and stretched tissue before the cut, mm, LPS
  Robot,         ///< the robot's base, mm
};
inline constexpr std::array<std::string_view, 3> kPathFrameNames{"sim_rest", "sim_stretched", "robot"};
[[nodiscard]] constexpr Names names_of(PathFrame) {
  return kPathFrameNames;
}

/// What the tool does along a path: cut the tissue, or only mark the line on it.
enum class PathKind { Incise, Mark };
inline constexpr std::array<std::string_view, 2> kPathKindNames{"incise", "mark"};
[[nodiscard]] constexpr Names names_of(PathKind) {
  return kPathKindNames;
}

struct Waypoint {
  Vec3 position_mm = Vec3::Zero();  ///< on the tissue's surface, in the path's frame
  Vec3 axis = -Vec3::UnitZ();       ///< unit; the direction in which the tool points into the tissue
  double depth_mm = kPlannedDepthMm;  ///< of the tool's tip below `position_mm`, along `axis`
  double speed_mm_s = 7.0;          ///< of the tip from this waypoint to the next
};
inline void describe(Visitor& v, Waypoint& w) {
  v("position_mm", w.position_mm, "Entry point on the tissue's surface, in the path's frame.");
  v("axis", w.axis, "Unit direction in which the tool points into the tissue.");
  v({"depth_mm", "Depth of the tool's tip below position_mm, along axis.", "mm"}, w.depth_mm, kNotNegative);
  v({"speed_mm_s", "Speed of the tip from this waypoint to the next.", "mm/s"}, w.speed_mm_s, kPositive);
}

/// The entry points of a tool along its way over the surface, with depth and axis at each: the content of `path.json`.
struct ToolPath {
  PathFrame frame = PathFrame::SimStretched;
  PathKind kind = PathKind::Incise;
  bool is_closed = true;               ///< the last waypoint joins the first
  std::vector<Waypoint> waypoints;
  Contour tumor_edge;                  ///< same frame; may be empty for an open cut
  std::optional<Mat4> T_robot_sim;     ///< once known; p_robot = T_robot_sim * p_sim, mm
  std::string source_sha256;           ///< of the path's source; empty: unknown
  std::string specimen_id = {};  ///< of the specimen that it was planned on (see io/specimen_id.hpp); empty: not stated
  bool is_virtual = false;       ///< the specimen is a synthetic body, not a patient's
};
inline void describe(Visitor& v, ToolPath& p) {
  v("frame", p.frame, "Frame of the path's coordinates.");
  v("kind", p.kind, "What the tool does along the path.");
  v("is_closed", p.is_closed, "Whether the last waypoint joins the first.");
  v("waypoints", p.waypoints, "Waypoints in order.");
  v("tumor_edge", p.tumor_edge, "Tumour edge in the same frame; may be empty for an open cut.");
  v("T_robot_sim", p.T_robot_sim, "Simulation to robot, once known: p_robot = T_robot_sim * p_sim, mm.");
  v("source_sha256", p.source_sha256, "SHA-256 of the path's source; empty: unknown.");
  v("specimen_id", p.specimen_id, "Id of the specimen that the path was planned on; empty: not stated.");
  v("is_virtual", p.is_virtual, "Whether the specimen is a synthetic body.");
}

/// Returns the entry points as a contour, mm, in the path's frame.
[[nodiscard]] Contour entry_contour(const ToolPath& path);

/// Time for the tip to follow the path once at its waypoints' speeds, s, without entry, overlap and exit.
/// @throws InvalidArgument for a speed that is not above 0.
[[nodiscard]] double duration_s(const ToolPath& path);

/// Returns the path without its provenance (source, specimen, whether virtual): two such paths are equal if the tool
/// does the same along them.
[[nodiscard]] ToolPath unmarked(ToolPath path);

}  // namespace incise
