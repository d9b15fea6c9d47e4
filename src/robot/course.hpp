#pragma once

#include "robot/speed_law.hpp"
#include "robot/tip_curve.hpp"

#include <incise/robot/program.hpp>

#include <vector>

namespace incise::robot_detail {

/// The tool's orientation for each direction of its axis: the frame about the mean axis, turned by the shortest
/// rotation to that direction. It depends on the axis alone, so a ring ends as it began.
class ToolFrame {
 public:
  /// @param hint  direction to which the tool's x axis lies as close as the mean axis allows, before the turn by
  ///   `spin_rad` about the mean axis.
  /// @throws InvalidArgument if an axis lies more than 120 degrees from the mean axis.
  ToolFrame(const ToolPath& path, const Vec3& hint, double spin_rad);
  [[nodiscard]] Mat3 at(const Vec3& axis) const;

 private:
  Vec3 mean_;
  Mat3 R_mean_;
};

/// Position and motion of the tip at one time.
struct CourseSample {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();
  double depth_mm = 0.0;
  double tip_speed_mm_s = 0.0;
  double arc_mm = 0.0;  ///< along the path; on the overlap more than its length; 0 off the path
  ProgramPhase phase = ProgramPhase::Approach;
  std::size_t waypoint = 0;  ///< at or before this place
};

/// One motion from rest to rest.
struct Leg {
  ProgramPhase phase = ProgramPhase::Approach;  ///< Cut includes the overlap
  double begin_s = 0.0, end_s = 0.0;
  TipSample place;                                ///< straight legs: the place on the curve along whose axis they run
  double from_depth_mm = 0.0, to_depth_mm = 0.0;  ///< straight legs
  double nominal_speed_mm_s = 0.0;                ///< straight legs
  SpeedLaw law;                                   ///< empty for a rest
};

/// The whole course of the tip over time: approach, plunge, cut with overlap, rest, exit, retreat.
class Course {
 public:
  /// @pre path and settings are valid (make_program checks them).
  Course(const ToolPath& path, const ProgramSettings& settings);
  [[nodiscard]] CourseSample at(double time_s) const;
  [[nodiscard]] double duration_s() const { return legs_.back().end_s; }
  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }
  [[nodiscard]] const TipCurve& curve() const { return curve_; }
  [[nodiscard]] double overlap_mm() const { return overlap_mm_; }

 private:
  void straight(ProgramPhase phase, const TipSample& place, double from_depth_mm, double to_depth_mm, double speed_mm_s,
                const ProgramSettings& settings);
  [[nodiscard]] std::vector<SpeedPiece> cut_pieces(const ToolPath& path) const;

  TipCurve curve_;
  double overlap_mm_ = 0.0;
  std::vector<Leg> legs_;
};

}  // namespace incise::robot_detail
