#pragma once

#include <incise/geometry/tool_path.hpp>

#include <vector>

namespace incise::robot_detail {

/// A place on the tip's course.
struct TipSample {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;  ///< of the waypoint at or before this place
};

/// The smooth course of the tool's tip through the waypoints of a path, measured by arc length. A closed course goes on
/// past its end.
class TipCurve {
 public:
  explicit TipCurve(const ToolPath& path);
  [[nodiscard]] double length_mm() const { return arc_mm_.back(); }
  /// @param arc_mm  from the first waypoint; beyond the length a closed course starts again, an open one has ended.
  [[nodiscard]] TipSample at(double arc_mm) const;
  /// Largest distance between the course and straight moves of equal arc length `spacing_mm`.
  [[nodiscard]] double chord_error_mm(std::size_t moves) const;

 private:
  std::vector<TipSample> fine_;  ///< closely spaced samples
  std::vector<double> arc_mm_;   ///< arc length at each
  bool is_closed_;
};

}  // namespace incise::robot_detail
