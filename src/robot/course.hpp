#pragma once

#include "robot/speed_law.hpp"
#include "robot/tip_curve.hpp"

#include <incise/robot/program.hpp>

#include <vector>

namespace incise::robot_detail {

/// How the tool is turned for each direction of its axis: its frame about the mean axis, swung by the shortest turn
/// from there. It depends on the axis alone, so a ring ends as it began.
class ToolFrame {
 public:
  /// @param hint  the tool's x axis lies as close to it as its mean axis allows, then is turned by `spin_rad` about it.
  /// @throws InvalidArgument when an axis lies more than 120 degrees from the mean one.
  ToolFrame(const ToolPath& path, const Vec3& hint, double spin_rad);
  [[nodiscard]] Mat3 at(const Vec3& axis) const;

 private:
  Vec3 mean_;
  Mat3 R_mean_;
};

/// Where the tip is at a time, and what it does there.
struct CourseSample {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();
  double depth_mm = 0.0;
  double tip_speed_mm_s = 0.0;
  double arc_mm = 0.0;  ///< along the path, beyond its length on the overlap
  ProgramPhase phase = ProgramPhase::Approach;
  std::size_t waypoint = 0;  ///< at or before this place
};

/// One motion from rest to rest.
struct Leg {
  ProgramPhase phase = ProgramPhase::Approach;  ///< Cut: with the overlap
  double begin_s = 0.0, end_s = 0.0;
  TipSample place;                                ///< straight legs: the place on the curve above which they run
  double from_depth_mm = 0.0, to_depth_mm = 0.0;  ///< straight legs
  double nominal_speed_mm_s = 0.0;                ///< straight legs
  SpeedLaw law;                                   ///< empty: a rest
};

/// The whole course of the tip over time: approach, plunge, cut with overlap, rest, exit, retreat.
class Course {
 public:
  /// @pre path and settings are valid (make_program looks at them).
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
