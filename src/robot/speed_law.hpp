#pragma once

#include <vector>

namespace incise::robot_detail {

/// A part of a course and its intended speed.
struct SpeedPiece {
  double length_mm = 0.0;
  double speed_mm_s = 0.0;
};

/// Arc length and speed on a course over time, from rest to rest, in phases of constant jerk (S-curves: acceleration
/// rises, stays constant, falls). The tip speeds up after the beginning of a faster piece, and slows down before the
/// beginning of a slower one. In a piece that is too short for its speed, the tip stays slower: acceleration and jerk
/// are never exceeded.
class SpeedLaw {
 public:
  SpeedLaw() = default;
  /// @pre lengths >= 0, one of them positive; speeds, acceleration and jerk positive.
  SpeedLaw(std::vector<SpeedPiece> pieces, double acceleration_mm_s2, double jerk_mm_s3);

  [[nodiscard]] double duration_s() const { return phases_.empty() ? 0.0 : phases_.back().end_s; }
  [[nodiscard]] double arc_mm(double time_s) const;      ///< 0 before the start, the length after the end
  [[nodiscard]] double speed_mm_s(double time_s) const;  ///< 0 outside (0, duration)
  [[nodiscard]] double time_s(double arc_mm) const;      ///< time at which a place is reached, to 1e-12 s

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
  // State at the end of the last phase, during construction.
  double arc_ = 0.0, speed_ = 0.0, rate_ = 0.0;
  std::vector<Phase> phases_;
};

}  // namespace incise::robot_detail
