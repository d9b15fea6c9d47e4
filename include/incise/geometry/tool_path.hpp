#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/types.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// The coordinates that a path is given in.
enum class PathFrame {
  SimRest,       ///< the undeformed mesh, mm, LPS
  SimStretched,  ///< the clamped and stretched tissue before the cut, mm, LPS
  Robot,         ///< the robot's base, mm
};
enum class PathKind { Incise, Mark };

[[nodiscard]] std::string_view to_string(PathFrame frame);  ///< sim_rest, sim_stretched, robot
[[nodiscard]] std::string_view to_string(PathKind kind);    ///< incise, mark

struct Waypoint {
  Vec3 position_mm = Vec3::Zero();  ///< on the tissue's surface, in the path's frame
  Vec3 axis = -Vec3::UnitZ();       ///< unit; the direction in which the tool points into the tissue
  double depth_mm = 5.0;            ///< of the tool's tip below `position_mm`, along `axis`
  double speed_mm_s = 7.0;          ///< of the tip from this waypoint to the next
};

/// The course of a tool's entry points over the surface, with depth and axis at each: what `path.json` holds.
struct ToolPath {
  PathFrame frame = PathFrame::SimStretched;
  PathKind kind = PathKind::Incise;
  bool is_closed = true;               ///< the last waypoint joins the first
  std::vector<Waypoint> waypoints;
  Contour tumor_edge;                  ///< same frame; may be empty for an open cut
  std::optional<Mat4> T_robot_sim;     ///< once known; p_robot = T_robot_sim * p_sim, mm
  std::string source_sha256;           ///< of what it was made from; empty when unknown
  std::string specimen_id = {};  ///< of the specimen that it was planned on (see io/specimen_id.hpp); empty: not stated
  bool is_virtual = false;       ///< the specimen is a synthetic body, not a patient's
};

/// The entry points as a contour.
[[nodiscard]] Contour entry_contour(const ToolPath& path);

/// Time to run the path once at its waypoints' speeds, s, without entry, overlap and exit.
[[nodiscard]] double duration_s(const ToolPath& path);

}  // namespace incise
