#pragma once

#include <incise/geometry/tool_path.hpp>

namespace incise {

/// A path in simulation coordinates, given in the robot's base frame: p_robot = T_robot_sim * p_sim, axes turned along.
/// @param T_robot_sim  rigid (scale 1), mm.  @throws InvalidArgument if the path is in the robot's frame already, or not in the stretched tissue.
[[nodiscard]] ToolPath in_robot_frame(ToolPath path, const Mat4& T_robot_sim);

}  // namespace incise
