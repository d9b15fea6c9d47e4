#pragma once

#include <incise/cutting/thermal.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/geometry/tool_path.hpp>

#include <cstddef>

namespace incise {

/// The greatest thermal half width along a path.
struct PathHeat {
  double half_width_mm = 0.0;  ///< see thermal_half_width_mm; 0: no waypoint heats tissue beside the electrode
  std::size_t waypoint = 0;    ///< the first waypoint with that half width
};

/// Returns the greatest thermal_half_width_mm over the waypoints of a path, each with its own speed and depth. A slow,
/// shallow cut heats most. The power is spread over the electrode's length in tissue: the waypoint's depth, at most the
/// tool's length; for a ball, which has no shaft, its diameter. The last waypoint of an open path takes the speed of
/// the waypoint before it. Waypoints with a depth of 0 mm or less heat nothing.
/// @param power_w  of the electrode, > 0.
/// @throws InvalidArgument as thermal_half_width_mm, and for a path without waypoints.
[[nodiscard]] PathHeat widest_heat(const ThermalSettings& settings, double power_w, const ToolPath& path,
                                   const Tool& tool);

}  // namespace incise
