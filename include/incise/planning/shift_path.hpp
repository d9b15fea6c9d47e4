#pragma once

#include <incise/planning/compensation.hpp>
#include <incise/planning/converging_compensation.hpp>

#include <vector>

namespace incise {

/// A path whose waypoints are moved by given distances over the surface, away from the nearest point of the tumour edge
/// or towards it: a correction that needs no simulated cut. Depth, speed, order and start stay as they are.
/// @param intended   closed path on the surface, with its tumour edge.
/// @param offset_mm  one per waypoint, positive = away from the tumour. As far as the region lets it: see is_limited.
/// @returns the path and its moves; `error_mm` holds what was to be made good, −offset_mm.
/// @throws InvalidArgument for an open path, no edge, or not one finite offset per waypoint; CaseError where the moved
/// path crosses itself or lies on tissue that is too thin.
[[nodiscard]] Compensation shift_path(const ToolPath& intended, const SurfaceQuery& surface,
                                      const std::vector<double>& offset_mm, const SafeRegion& region = {});

}  // namespace incise
