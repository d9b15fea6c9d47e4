#pragma once

#include <incise/geometry/tool_path.hpp>

#include <vector>

namespace incise::robot_detail {

/// A place on the tip's course.
struct TipSample {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;   ///< of the waypoint at or before this place
  std::size_t waypoint = 0;  ///< at or before this place
};

/// The smooth course of the tool's tip through the waypoints of a path, measured by arc length. A closed course goes on
/// past its end.
///
/// Between two waypoints: the quintic with the places, slopes and second derivatives that the parabolas through each
/// waypoint and its neighbours have there, over the chord length. So direction and curvature of the tip's course, and
/// those of the axis, are continuous, and one waypoint moves no more than three pieces on either side.
class TipCurve {
 public:
  explicit TipCurve(const ToolPath& path);
  [[nodiscard]] double length_mm() const { return fine_.back().arc_mm; }
  /// @param arc_mm  from the first waypoint; beyond the length a closed course starts again, an open one has ended.
  [[nodiscard]] TipSample at(double arc_mm) const;
  /// Largest distance between the course and straight moves of equal arc length `spacing_mm`.
  [[nodiscard]] double chord_error_mm(std::size_t moves) const;
  /// Arc length at waypoint i; the one past the last is the length of a closed course.
  [[nodiscard]] double arc_at_waypoint(std::size_t i) const;

 private:
  /// A curve's place, slope and second derivative at a waypoint.
  struct Knot {
    Vec3 value, slope, bend;
  };
  struct Piece {
    Knot tip_from, tip_to, axis_from, axis_to;
    double chord_mm = 0.0;
    double depth_from_mm = 0.0, depth_to_mm = 0.0;
    double speed_mm_s = 0.0;
  };
  struct Fine {
    double arc_mm = 0.0;
    double t_per_mm = 0.0;         ///< slope of the piece's parameter over the arc length
    double t_per_mm_at_end = 0.0;  ///< at the next sample; pieces differ in their parameter
    Vec3 tip_mm;
  };
  [[nodiscard]] static std::vector<Knot> knots(const std::vector<Vec3>& values, const std::vector<double>& chords,
                                               bool is_closed);
  [[nodiscard]] static Vec3 value(const Knot& from, const Knot& to, double chord, double t);
  [[nodiscard]] static Vec3 slope(const Knot& from, const Knot& to, double chord, double t);
  [[nodiscard]] TipSample sample(std::size_t piece, double t) const;

  std::vector<Piece> pieces_;
  std::vector<Fine> fine_;  ///< closely spaced samples, the same count in every piece, and the end
  bool is_closed_;
};

}  // namespace incise::robot_detail
