#include "robot/course.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

/// The rotation whose z axis is `axis` and whose x axis lies as close as possible to `hint`.
Mat3 rotation_with(const Vec3& axis, const Vec3& hint) {
  Vec3 x = hint - hint.dot(axis) * axis;
  if (x.norm() < 1e-3 * hint.norm()) {  // the hint lies along the axis: any direction across it will do
    x = Vec3::UnitY() - axis.y() * axis;
    if (x.norm() < 0.5) x = Vec3::UnitX() - axis.x() * axis;
  }
  Mat3 rotation;
  rotation.col(0) = x.normalized();
  rotation.col(2) = axis;
  rotation.col(1) = axis.cross(rotation.col(0));
  return rotation;
}

}  // namespace

ToolFrame::ToolFrame(const ToolPath& path, const Vec3& hint, double spin_rad) {
  constexpr double kLeastCosine = -0.5;  // near 180 degrees the shortest turn is not unique
  Vec3 sum = Vec3::Zero();
  for (const Waypoint& waypoint : path.waypoints) sum += waypoint.axis;
  INCISE_REQUIRE(sum.norm() > 1e-6 * static_cast<double>(path.waypoints.size()),
                 "expected tool axes with a mean direction, found axes that cancel out");
  mean_ = sum.normalized();
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    INCISE_REQUIRE(
        mean_.dot(path.waypoints[i].axis) > kLeastCosine,
        fmt::format("expected tool axes within 120 degrees of their mean, found a larger angle at waypoint {}", i));
  }
  R_mean_ = Eigen::AngleAxisd(spin_rad, mean_).toRotationMatrix() * rotation_with(mean_, hint);
}

Mat3 ToolFrame::at(const Vec3& axis) const {
  // The shortest rotation from the mean axis: I + [v] + [v]² / (1 + c), with v the cross and c the scalar product.
  const Vec3 v = mean_.cross(axis);
  Mat3 cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return (Mat3::Identity() + cross + cross * cross / (1.0 + mean_.dot(axis))) * R_mean_;
}

Course::Course(const ToolPath& path, const ProgramSettings& s) : curve_(path) {
  if (path.is_closed) {
    overlap_mm_ = s.overlap_mm;
    INCISE_REQUIRE(
        overlap_mm_ < curve_.length_mm(),
        fmt::format("expected an overlap below the path's {:.4g} mm, found {} mm", curve_.length_mm(), overlap_mm_));
  }
  const TipSample start = curve_.at(0.0);
  const TipSample end = curve_.at(curve_.length_mm() + overlap_mm_);
  straight(ProgramPhase::Approach, start, -s.approach_height_mm, -s.clearance_mm, s.approach_speed_mm_s, s);
  straight(ProgramPhase::Plunge, start, -s.clearance_mm, start.depth_mm, s.plunge_speed_mm_s, s);
  Leg cut{.phase = ProgramPhase::Cut, .begin_s = legs_.back().end_s};
  cut.law = SpeedLaw(cut_pieces(path), s.acceleration_mm_s2, s.jerk_mm_s3);
  cut.end_s = cut.begin_s + cut.law.duration_s();
  legs_.push_back(cut);
  if (s.dwell_s > 0.0) {
    legs_.push_back({.phase = ProgramPhase::Dwell,
                     .begin_s = cut.end_s,
                     .end_s = cut.end_s + s.dwell_s,
                     .place = end,
                     .from_depth_mm = end.depth_mm,
                     .to_depth_mm = end.depth_mm});
  }
  straight(ProgramPhase::Exit, end, end.depth_mm, -s.clearance_mm, s.plunge_speed_mm_s, s);
  straight(ProgramPhase::Retreat, end, -s.clearance_mm, -s.approach_height_mm, s.approach_speed_mm_s, s);
}

void Course::straight(ProgramPhase phase, const TipSample& place, double from_depth_mm, double to_depth_mm,
                      double speed_mm_s, const ProgramSettings& settings) {
  const double length = std::abs(to_depth_mm - from_depth_mm);
  if (length <= 0.0) return;
  Leg leg{.phase = phase,
          .begin_s = legs_.empty() ? 0.0 : legs_.back().end_s,
          .place = place,
          .from_depth_mm = from_depth_mm,
          .to_depth_mm = to_depth_mm,
          .nominal_speed_mm_s = speed_mm_s};
  leg.law = SpeedLaw({{length, speed_mm_s}}, settings.acceleration_mm_s2, settings.jerk_mm_s3);
  leg.end_s = leg.begin_s + leg.law.duration_s();
  legs_.push_back(leg);
}

std::vector<SpeedPiece> Course::cut_pieces(const ToolPath& path) const {
  const double end = curve_.length_mm() + overlap_mm_;
  std::vector<SpeedPiece> pieces;
  const std::size_t count = path.is_closed ? path.waypoints.size() : path.waypoints.size() - 1;
  for (double lap = 0.0; lap < end; lap += curve_.length_mm()) {
    for (std::size_t i = 0; i < count; ++i) {
      const double from = lap + curve_.arc_at_waypoint(i), to = std::min(end, lap + curve_.arc_at_waypoint(i + 1));
      if (to <= from) break;
      if (!pieces.empty() && pieces.back().speed_mm_s == path.waypoints[i].speed_mm_s)
        pieces.back().length_mm += to - from;
      else
        pieces.push_back({to - from, path.waypoints[i].speed_mm_s});
    }
  }
  return pieces;
}

CourseSample Course::at(double time_s) const {
  const auto after = std::upper_bound(legs_.begin() + 1, legs_.end(), time_s,
                                      [](double time, const Leg& leg) { return time < leg.begin_s; });
  const Leg& leg = *(after - 1);
  const double time = time_s - leg.begin_s;
  const double arc = leg.law.arc_mm(time), speed = leg.law.speed_mm_s(time);
  if (leg.phase == ProgramPhase::Cut) {
    const TipSample place = curve_.at(arc);
    const bool is_overlap = overlap_mm_ > 0.0 && arc > curve_.length_mm();
    return {place.tip_mm,  place.axis, place.depth_mm, speed, arc, is_overlap ? ProgramPhase::Overlap : leg.phase,
            place.waypoint};
  }
  const double depth = leg.from_depth_mm + (leg.to_depth_mm > leg.from_depth_mm ? arc : -arc);
  return {leg.place.tip_mm + (depth - leg.place.depth_mm) * leg.place.axis,
          leg.place.axis,
          depth,
          speed,
          0.0,
          leg.phase,
          leg.place.waypoint};
}

}  // namespace incise::robot_detail
