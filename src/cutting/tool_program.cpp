#include <incise/core/error.hpp>
#include <incise/cutting/tool_program.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kMovesAlong = 1e-6;  // share of a move across the axis below which the tool moves along its axis

ToolPose pose_of(const Waypoint& waypoint, const Vec3& heading) {
  return {waypoint.position_mm + waypoint.depth_mm * waypoint.axis, waypoint.axis, heading_across(heading, waypoint.axis)};
}

/// Travel of a tool between two poses, mm: the way of its tip or, if only its axis turns, the way of the point
/// `depth_mm` behind the tip.
double travel_mm(const ToolPose& from, const ToolPose& to, double depth_mm) {
  const double tip = (to.tip_mm - from.tip_mm).norm();
  return tip > 0.0 ? tip : depth_mm * (to.axis - from.axis).norm();
}

/// The heading of a tool whose tip moves from one place to another; along its axis it keeps the given heading.
Vec3 led_along(const Vec3& from_tip, const Vec3& to_tip, const Vec3& axis, const Vec3& heading) {
  const Vec3 way = to_tip - from_tip;
  const double across = (way - axis.dot(way) * axis).norm();
  return heading_across(across > kMovesAlong * way.norm() ? way : heading, axis);
}

void require_usable(const ToolPath& path) {
  const std::size_t least = path.is_closed ? 3 : 2;
  INCISE_REQUIRE(path.frame == PathFrame::SimStretched,
                 fmt::format("expected a path in frame sim_stretched, found {}", to_string(path.frame)));
  INCISE_REQUIRE(path.waypoints.size() >= least,
                 fmt::format("expected at least {} waypoints, found {}", least, path.waypoints.size()));
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const Waypoint& w = path.waypoints[i];
    INCISE_REQUIRE(w.position_mm.allFinite() && w.axis.allFinite() && std::isfinite(w.depth_mm),
                   fmt::format("waypoint {} is not finite", i));
    INCISE_REQUIRE(std::abs(w.axis.norm() - 1.0) < 1e-6, fmt::format("waypoint {}: the axis is not a unit vector", i));
    INCISE_REQUIRE(w.depth_mm > 0.0, fmt::format("waypoint {}: found depth {} mm, expected above 0", i, w.depth_mm));
  }
}

}  // namespace

double tip_way_mm(const ToolPath& path) {
  const auto tip = [&path](std::size_t i) -> Vec3 { return path.waypoints[i].position_mm + path.waypoints[i].depth_mm * path.waypoints[i].axis; };
  double way = 0.0;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) way += (tip(i) - tip(i - 1)).norm();
  if (path.is_closed && path.waypoints.size() > 1) way += (tip(0) - tip(path.waypoints.size() - 1)).norm();
  return way;
}

ToolProgram::ToolProgram(const ToolPath& path, const CutSettings& settings, const Tool& tool) {
  require_usable(path);
  INCISE_REQUIRE(!path.is_closed || settings.overlap_mm < tip_way_mm(path),
                 fmt::format("expected an overlap below the ring's {} mm, found {}", tip_way_mm(path), settings.overlap_mm));
  const double speed = settings.speed_mm_s;
  const Waypoint& first = path.waypoints.front();
  const Vec3 any = Vec3::UnitX();
  const Vec3 second_tip = pose_of(path.waypoints[1], any).tip_mm;
  const Vec3 ahead = led_along(pose_of(first, any).tip_mm, second_tip, first.axis, any);
  keys_.push_back({0.0, {first.position_mm, first.axis, ahead}, Phase::Plunge});

  // A tool turns into the direction of a move before it moves; one that is round about its axis needs no time for it.
  const auto turn_to = [&](const Vec3& heading, Phase phase) {
    const ToolPose from = keys_.back().pose;
    const double distance = half_width_mm(tool) * std::abs(turn_rad(from.heading, heading, from.axis));
    const Key turned{keys_.back().time_s + distance / speed, {from.tip_mm, from.axis, heading}, phase};
    keys_.push_back(turned);
  };
  const auto move_to = [&](const Waypoint& waypoint, double share, Phase phase) {
    const ToolPose from = keys_.back().pose;
    const ToolPose end = pose_of(waypoint, from.heading);
    ToolPose to = share < 1.0 ? between(from, end, share) : end;
    const double distance = travel_mm(from, to, first.depth_mm);
    if (!(distance > 0.0)) return;
    const Vec3 heading = led_along(from.tip_mm, to.tip_mm, from.axis, from.heading);
    if (heading != from.heading) turn_to(heading, phase);
    to.heading = heading_across(heading, to.axis);
    keys_.push_back({keys_.back().time_s + distance / speed, to, phase});
  };
  move_to(first, 1.0, Phase::Plunge);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) move_to(path.waypoints[i], 1.0, Phase::Follow);

  if (path.is_closed) {
    move_to(first, 1.0, Phase::Follow);
    double left = settings.overlap_mm;
    for (std::size_t i = 1; left > 0.0 && i <= path.waypoints.size(); ++i) {
      const Waypoint& next = path.waypoints[i % path.waypoints.size()];
      const double distance = (pose_of(next, any).tip_mm - keys_.back().pose.tip_mm).norm();
      move_to(next, distance <= left ? 1.0 : left / distance, Phase::Overlap);
      left -= distance;
    }
  }
  keys_.push_back({keys_.back().time_s + 1.0 / settings.dwell_rate_per_s(), keys_.back().pose, Phase::Dwell});
  for (std::size_t i = 1; i < keys_.size(); ++i) {
    keys_[i].way_mm = keys_[i - 1].way_mm + (keys_[i].pose.tip_mm - keys_[i - 1].pose.tip_mm).norm();
  }
}

std::size_t ToolProgram::key_after(double time_s) const {
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                     [](double time, const Key& key) { return time < key.time_s; });
  return std::min(static_cast<std::size_t>(next - keys_.begin()), keys_.size() - 1);
}

ToolPose ToolProgram::pose_at(double time_s) const {
  if (time_s <= 0.0) return keys_.front().pose;
  if (time_s >= duration_s()) return keys_.back().pose;
  const Key& to = keys_[key_after(time_s)];
  const Key& from = keys_[key_after(time_s) - 1];
  return between(from.pose, to.pose, (time_s - from.time_s) / (to.time_s - from.time_s));
}

double ToolProgram::way_mm_at(double time_s) const {
  if (time_s <= 0.0) return 0.0;
  if (time_s >= duration_s()) return keys_.back().way_mm;
  const Key& to = keys_[key_after(time_s)];
  const Key& from = keys_[key_after(time_s) - 1];
  return from.way_mm + (to.way_mm - from.way_mm) * (time_s - from.time_s) / (to.time_s - from.time_s);
}

ToolProgram::Phase ToolProgram::phase_at(double time_s) const { return keys_[key_after(time_s)].phase; }

}  // namespace incise
