#pragma once

#include <incise/cutting/thermal.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/geometry/tool_path.hpp>

#include <cstddef>

namespace incise {

/// Where along a path heat reaches farthest beside the electrode.
struct PathHeat {
  double half_width_mm = 0.0;  ///< see thermal_half_width_mm; 0: the electrode is nowhere in the tissue
  std::size_t waypoint = 0;    ///< the first with that half width
};

/// The widest of thermal_half_width_mm over the waypoints of a path, each with its own speed and depth: slow and
/// shallow is worst. The power is spread over the electrode's length in tissue, `depth_mm` and at most the tool's
/// length; of a ball, which has no shaft, its diameter. The end of an open path is reached at the speed of the waypoint
/// before it. Waypoints that are no deeper than 0 mm heat nothing.
/// @throws InvalidArgument as thermal_half_width_mm, and for a path without waypoints.
[[nodiscard]] PathHeat widest_heat(const ThermalSettings& settings, double power_w, const ToolPath& path,
                                   const Tool& tool);

}  // namespace incise
