#pragma once

#include <incise/planning/compensation.hpp>
#include <incise/planning/converging_compensation.hpp>

#include <vector>

namespace incise {

/// Moves the waypoints of a path by given distances over the surface, away from the nearest point of the tumour edge or
/// towards it: a correction that needs no simulated cut. Depth, speed, order and start do not change.
/// @param intended   closed path on the surface, with its tumour edge.
/// @param offset_mm  one per waypoint, mm, positive = away from the tumour. The region may cut a move short: see
/// is_limited.
/// @returns the path and its moves; `error_mm` holds the errors that the moves correct, −offset_mm.
/// @throws InvalidArgument for an open path, no edge, or not one finite offset per waypoint; CaseError for a waypoint
/// on the tumour edge, or if the moved path fails check_path.
[[nodiscard]] Compensation shift_path(const ToolPath& intended, const SurfaceQuery& surface,
                                      const std::vector<double>& offset_mm, const SafeRegion& region = {});

}  // namespace incise
