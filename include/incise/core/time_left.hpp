#pragma once

#include <optional>

namespace incise {

/// Estimates the remaining time of a computation from its progress. The estimate counts down with the clock and follows
/// a changed pace over a tenth of the whole time, so it does not jump. A computation may start at any fraction: one
/// that resumes at 60 % does not seem faster. Where the fraction falls, the next computation has begun.
class TimeLeft {
 public:
  /// @param elapsed_s  on any clock, never less than in the call before.
  /// @param fraction   done so far, in [0, 1]; less than in the call before: another computation has begun.
  void note(double elapsed_s, double fraction);
  /// Returns the remaining time at the last note, s; nullopt until 2 % of the whole was done since the first note.
  [[nodiscard]] std::optional<double> seconds() const { return left_s_; }

 private:
  struct Moment {
    double elapsed_s;
    double fraction;
  };
  std::optional<Moment> first_;
  Moment last_{0.0, 0.0};
  std::optional<double> left_s_;
};

}  // namespace incise
