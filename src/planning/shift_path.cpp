#include "planning/safe_moves.hpp"

#include <incise/core/error.hpp>
#include <incise/planning/shift_path.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {

Compensation shift_path(const ToolPath& intended, const SurfaceQuery& surface, const std::vector<double>& offset_mm,
                        const SafeRegion& region) {
  INCISE_REQUIRE(intended.is_closed && intended.tumor_edge.is_closed && intended.tumor_edge.points.size() >= 3,
                 "expected a closed path with a closed tumour edge of at least 3 points");
  INCISE_REQUIRE(offset_mm.size() == intended.waypoints.size() &&
                     std::all_of(offset_mm.begin(), offset_mm.end(), [](double o) { return std::isfinite(o); }),
                 fmt::format("expected one finite offset for each of {} waypoints, found {}", intended.waypoints.size(),
                             offset_mm.size()));
  MovablePath::Moved moved = MovablePath(intended, surface, region).at(offset_mm);
  check_path_as({"compensation"}, moved.path, surface, region.approach, 0.0);
  Compensation result;
  result.path = std::move(moved.path);
  for (const double offset : offset_mm) result.error_mm.push_back(-offset);
  result.is_interpolated.assign(offset_mm.size(), 0);
  result.move_mm = std::move(moved.offset_mm);
  result.is_limited = std::move(moved.is_limited);
  count_moves(result);
  return result;
}

}  // namespace incise
