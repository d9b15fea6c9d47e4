#pragma once

#include <incise/geometry/tool_path.hpp>

namespace incise {

/// Transforms a path, with its axes and tumour edge, from simulation coordinates to the robot's base frame: p_robot =
/// T_robot_sim * p_sim.
/// @param T_robot_sim  rigid (scale 1), mm.  @throws InvalidArgument unless the path is in frame sim_stretched.
[[nodiscard]] ToolPath in_robot_frame(ToolPath path, const Mat4& T_robot_sim);

}  // namespace incise
