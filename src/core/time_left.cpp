#include <incise/core/time_left.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kLeastFraction = 0.02;    // must be done before a pace is estimated
constexpr double kSmoothingShare = 0.1;    // of the whole time

}  // namespace

void TimeLeft::note(double elapsed_s, double fraction) {
  if (!first_ || fraction < last_.fraction) {
    first_ = Moment{elapsed_s, fraction};
    left_s_.reset();
  }
  const double since_last_s = elapsed_s - last_.elapsed_s;
  last_ = Moment{elapsed_s, fraction};
  const double done = fraction - first_->fraction;
  if (done < kLeastFraction) return;
  const double spent_s = elapsed_s - first_->elapsed_s;
  const double by_pace_s = spent_s * (1.0 - fraction) / done;
  if (!left_s_) {
    left_s_ = by_pace_s;
    return;
  }
  const double counted_down_s = *left_s_ - since_last_s;
  const double smoothing_s = kSmoothingShare * (spent_s + by_pace_s);
  const double weight = smoothing_s > 0.0 ? 1.0 - std::exp(-since_last_s / smoothing_s) : 1.0;
  left_s_ = std::max(0.0, counted_down_s + weight * (by_pace_s - counted_down_s));
}

}  // namespace incise
