#include <incise/core/error.hpp>
#include <incise/cutting/tool_program.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

ToolPose pose_of(const Waypoint& waypoint) {
  return {waypoint.position_mm + waypoint.depth_mm * waypoint.axis, waypoint.axis};
}

/// How far a tool goes from one pose to another: the way of its tip or, where it only turns, that of the point `depth_mm` behind the tip.
double travel_mm(const ToolPose& from, const ToolPose& to, double depth_mm) {
  const double tip = (to.tip_mm - from.tip_mm).norm();
  return tip > 0.0 ? tip : depth_mm * (to.axis - from.axis).norm();
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

ToolPose between(const ToolPose& a, const ToolPose& b, double t) {
  return {a.tip_mm + t * (b.tip_mm - a.tip_mm), (a.axis + t * (b.axis - a.axis)).normalized()};
}

ToolProgram::ToolProgram(const ToolPath& path, const CutSettings& settings) {
  require_usable(path);
  const double speed = settings.speed_mm_s;
  const Waypoint& first = path.waypoints.front();
  keys_.push_back({0.0, {first.position_mm, first.axis}, Phase::Plunge});

  const auto move_to = [&](const ToolPose& pose, Phase phase) {
    const double distance = travel_mm(keys_.back().pose, pose, first.depth_mm);
    if (distance > 0.0) keys_.push_back({keys_.back().time_s + distance / speed, pose, phase});
  };
  move_to(pose_of(first), Phase::Plunge);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) move_to(pose_of(path.waypoints[i]), Phase::Follow);

  if (path.is_closed) {
    move_to(pose_of(first), Phase::Follow);
    double left = settings.overlap_mm;
    for (std::size_t i = 1; left > 0.0 && i < path.waypoints.size(); ++i) {
      const ToolPose from = keys_.back().pose;
      const ToolPose to = pose_of(path.waypoints[i]);
      const double distance = (to.tip_mm - from.tip_mm).norm();
      move_to(distance <= left ? to : between(from, to, left / distance), Phase::Overlap);
      left -= distance;
    }
  }
  keys_.push_back({keys_.back().time_s + settings.dwell_s(), keys_.back().pose, Phase::Dwell});
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

ToolProgram::Phase ToolProgram::phase_at(double time_s) const { return keys_[key_after(time_s)].phase; }

}  // namespace incise
