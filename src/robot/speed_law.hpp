#pragma once

#include <vector>

namespace incise::robot_detail {

/// A stretch of a course and the speed to run it at.
struct SpeedPiece {
  double length_mm = 0.0;
  double speed_mm_s = 0.0;
};

/// Place and speed on a course over time, from rest to rest: pieces of constant jerk (an S-curve: acceleration rises,
/// stays, falls). A higher speed begins to build up where its piece begins; a lower one is reached before its piece
/// begins. Where a piece is too short for its speed, it is run more slowly: acceleration and jerk are never exceeded.
class SpeedLaw {
 public:
  SpeedLaw() = default;
  /// @pre lengths >= 0, one of them positive; speeds, acceleration and jerk positive.
  SpeedLaw(std::vector<SpeedPiece> pieces, double acceleration_mm_s2, double jerk_mm_s3);

  [[nodiscard]] double duration_s() const { return phases_.empty() ? 0.0 : phases_.back().end_s; }
  [[nodiscard]] double arc_mm(double time_s) const;      ///< before the start 0, after the end the length
  [[nodiscard]] double speed_mm_s(double time_s) const;  ///< outside [0, duration] 0
  [[nodiscard]] double time_s(double arc_mm) const;      ///< when a place is reached, to 1e-12 s

 private:
  struct Phase {
    double begin_s, end_s, arc_mm, speed_mm_s, acceleration_mm_s2, jerk_mm_s3;
  };
  [[nodiscard]] const Phase& phase_at(double time_s) const;
  void add(double seconds, double jerk);
  void change_speed(double to_mm_s);
  [[nodiscard]] double change_length(double from_mm_s, double to_mm_s) const;
  [[nodiscard]] double reachable_speed(double from_mm_s, double length_mm, double cap_mm_s) const;

  double acceleration_ = 0.0, jerk_ = 0.0;
  double length_mm_ = 0.0;
  // State at the end of the last phase, while building.
  double arc_ = 0.0, speed_ = 0.0, rate_ = 0.0;
  std::vector<Phase> phases_;
};

}  // namespace incise::robot_detail
