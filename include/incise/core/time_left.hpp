#pragma once

#include <optional>

namespace incise {

/// Tells from how far a computation is how long it still takes. What it tells counts down with the clock and follows a changed pace over a
/// tenth of the whole time, so that it does not jump. A computation may begin anywhere: one that is resumed at 60 % is no faster for that.
class TimeLeft {
 public:
  /// @param elapsed_s  on any clock, never less than in the call before.
  /// @param fraction   done so far, in [0, 1], never less than in the call before.
  void note(double elapsed_s, double fraction);
  /// s, at the time of the last note; nothing until a fiftieth of all is done since the first.
  [[nodiscard]] std::optional<double> seconds() const { return left_s_; }

 private:
  struct Moment {
    double elapsed_s;
    double fraction;
  };
  std::optional<Moment> first_;
  double last_s_ = 0.0;
  std::optional<double> left_s_;
};

}  // namespace incise
