#include "planning/safe_moves.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr int kShareBisections = 60;
/// Distance by which a move stays inside a limit to which the finished path is then held: more than rounding.
constexpr double kLimitSlackMm = 1e-6;

struct Move {
  Vec3 position_mm;
  double length_mm = 0.0;  // straight distance in space, >= 0
};

Move move_over(const Vec2& start, const Vec2& heading, double length_mm, bool is_inward, const SurfaceView& view,
               const Contour& edge, const SafeRegion& region) {
  const Vec3 origin = view.at(start)->position_mm;
  const double least = region.close_margin_mm + region.electrode_radius_mm;
  const double rim_clearance = region.rim_clearance_mm > 0.0 ? region.rim_clearance_mm + kLimitSlackMm : 0.0;
  const auto reach = [&](double step) -> std::optional<Move> {
    const Vec2 place = start + step * heading;
    const std::optional<SurfacePoint> seen = view.at(place);
    if (!seen || !view.is_clear_of_rim(place, rim_clearance)) return std::nullopt;
    const double distance = nearest_on(edge, seen->position_mm).distance_mm;
    if (is_inward && (distance < least || contains_in_view(edge, seen->position_mm, region.approach)))
      return std::nullopt;
    return Move{seen->position_mm, (seen->position_mm - origin).norm()};
  };
  // Over a slope, a step in the picture moves the waypoint farther in space, never less far.
  double near = 0.0;
  double far = length_mm;
  Move best{origin, 0.0};
  if (const std::optional<Move> full = reach(far); full && full->length_mm <= length_mm + 1e-12) return *full;
  for (int n = 0; n < kShareBisections; ++n) {
    const double middle = 0.5 * (near + far);
    const std::optional<Move> there = reach(middle);
    if (there && there->length_mm <= length_mm) {
      near = middle;
      best = *there;
    } else {
      far = middle;
    }
  }
  return best;
}

}  // namespace

double move_waypoint(Waypoint& waypoint, const Vec2& outward, double wanted_mm, const SurfaceView& view,
                     const Contour& edge, const SafeRegion& region) {
  const bool is_inward = wanted_mm < 0.0;
  const double sign = is_inward ? -1.0 : 1.0;
  const double length = std::min(std::abs(wanted_mm), region.max_offset_mm);
  const Move move =
      move_over(view.place_of(waypoint.position_mm), sign * outward, length, is_inward, view, edge, region);
  waypoint.position_mm = move.position_mm;
  if (region.axis_mode == AxisMode::SurfaceNormal) {
    waypoint.axis = view.tool_axis(view.place_of(move.position_mm), region.axis_mode);
  }
  return sign * move.length_mm;
}

MovablePath::MovablePath(const ToolPath& intended, const SurfaceQuery& surface, const SafeRegion& region)
    : intended_(intended), surface_(surface), region_(region), view_(surface, region.approach) {
  const Contour& edge = intended_.tumor_edge;
  for (std::size_t i = 0; i < intended_.waypoints.size(); ++i) {
    const Vec3& position = intended_.waypoints[i].position_mm;
    const Vec2 away = view_.place_of(position) - view_.place_of(nearest_on(edge, position).position_mm);
    if (away.norm() < kMoveToleranceMm) {
      throw CaseError("compensation", "path", fmt::format("waypoint {} on the tumour edge", i),
                      "a path that keeps clear of the tumour");
    }
    headings_.push_back((contains_in_view(edge, position, region_.approach) ? -1.0 : 1.0) * away.normalized());
  }
}

MovablePath::Moved MovablePath::at(const std::vector<double>& offset_mm) const {
  Moved moved{intended_, {}, {}};
  moved.path.source_sha256.clear();  // it no longer matches the file
  for (std::size_t i = 0; i < offset_mm.size(); ++i) {
    const double reached_mm =
        move_waypoint(moved.path.waypoints[i], headings_[i], offset_mm[i], view_, intended_.tumor_edge, region_);
    moved.offset_mm.push_back(reached_mm);
    moved.is_limited.push_back(std::abs(offset_mm[i]) - std::abs(reached_mm) > kMoveToleranceMm ? 1 : 0);
  }
  return moved;
}

bool MovablePath::can_be_cut(const ToolPath& path) const {
  try {
    check_path_as({"compensation"}, path, surface_, region_.approach, 0.0);
  } catch (const CaseError&) {
    return false;
  }
  return true;
}

}  // namespace incise
