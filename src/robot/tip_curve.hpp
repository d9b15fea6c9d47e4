#pragma once

#include <incise/geometry/tool_path.hpp>

#include <vector>

namespace incise::robot_detail {

/// The place of a segment that is nearest to a point.
struct SegmentPlace {
  double share = 0.0;  ///< of the way from its begin to its end
  double distance_mm = 0.0;
};
/// Returns the place on a segment that is nearest to p; its begin if it has no length.
[[nodiscard]] SegmentPlace nearest_on_segment(const Vec3& p, const Vec3& begin, const Vec3& end);

/// A place on the tip's course.
struct TipSample {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;   ///< of the waypoint at or before this place
  std::size_t waypoint = 0;  ///< at or before this place
};

/// The smooth course of the tool's tip through the waypoints of a path, parametrised by arc length. A closed course
/// continues past its end.
///
/// Between two waypoints the course is a quintic over the chord length. Its position, slope and second derivative at
/// each waypoint are those of the parabola through that waypoint and its neighbours. Thus direction and curvature of
/// the tip's course and of the axis are continuous, and a waypoint affects at most three pieces on either side.
class TipCurve {
 public:
  explicit TipCurve(const ToolPath& path);
  [[nodiscard]] double length_mm() const { return fine_.back().arc_mm; }
  /// Returns the place at an arc length from the first waypoint. Beyond the length, a closed course starts again and an
  /// open one stays at its end.
  [[nodiscard]] TipSample at(double arc_mm) const;
  /// Returns the greatest distance between the course and `moves` straight moves over equal arc lengths, mm.
  [[nodiscard]] double chord_error_mm(std::size_t moves) const;
  /// Returns the arc length at waypoint i; for i past the last waypoint, the length of a closed course.
  [[nodiscard]] double arc_at_waypoint(std::size_t i) const;

 private:
  /// A curve's position, slope and second derivative at a waypoint.
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
    double t_per_mm = 0.0;         ///< derivative of the piece's parameter with respect to arc length
    double t_per_mm_at_end = 0.0;  ///< the same at the next sample, still in this piece's parameter
    Vec3 tip_mm;
  };
  [[nodiscard]] static std::vector<Knot> knots(const std::vector<Vec3>& values, const std::vector<double>& chords,
                                               bool is_closed);
  [[nodiscard]] static Vec3 value(const Knot& from, const Knot& to, double chord, double t);
  [[nodiscard]] static Vec3 slope(const Knot& from, const Knot& to, double chord, double t);
  [[nodiscard]] TipSample sample(std::size_t piece, double t) const;

  std::vector<Piece> pieces_;
  std::vector<Fine> fine_;  ///< closely spaced samples, equally many in every piece, and the end
  bool is_closed_;
};

}  // namespace incise::robot_detail
