#include "robot/speed_law.hpp"

#include <incise/core/error.hpp>

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

constexpr int kBisections = 60;  // to the last bits

/// The greatest x in [low, high] for which the rule holds. @pre it holds at low and, once broken, stays so.
template <class Rule>
double last_that_keeps(double low, double high, const Rule& rule) {
  if (rule(high)) return high;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (rule(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

SpeedLaw::SpeedLaw(std::vector<SpeedPiece> pieces, double acceleration_mm_s2, double jerk_mm_s3)
    : acceleration_(acceleration_mm_s2), jerk_(jerk_mm_s3) {
  for (const SpeedPiece& piece : pieces) length_mm_ += piece.length_mm;
  INCISE_REQUIRE(length_mm_ > 0.0, "expected a course longer than 0 mm");
  std::erase_if(pieces, [](const SpeedPiece& piece) { return piece.length_mm <= 0.0; });
  // Speeds where pieces meet: limited by both pieces, by speeding up from the start and by slowing down to the end.
  const std::size_t n = pieces.size();
  std::vector<double> at(n + 1, 0.0);
  for (std::size_t i = 1; i < n; ++i) at[i] = std::min(pieces[i - 1].speed_mm_s, pieces[i].speed_mm_s);
  for (std::size_t i = 0; i < n; ++i) at[i + 1] = reachable_speed(at[i], pieces[i].length_mm, at[i + 1]);
  for (std::size_t i = n; i > 0; --i) at[i - 1] = reachable_speed(at[i], pieces[i - 1].length_mm, at[i - 1]);
  for (std::size_t i = 0; i < n; ++i) {
    const double low = std::max(at[i], at[i + 1]);
    const auto fits = [&](double peak) {
      return change_length(at[i], peak) + change_length(peak, at[i + 1]) <= pieces[i].length_mm;
    };
    const double peak = last_that_keeps(low, std::max(low, pieces[i].speed_mm_s), fits);
    const double rest = pieces[i].length_mm - change_length(at[i], peak) - change_length(peak, at[i + 1]);
    change_speed(peak);
    if (rest > 0.0) add(rest / peak, 0.0);
    change_speed(at[i + 1]);
  }
}

double SpeedLaw::change_length(double from, double to) const {
  const double change = std::abs(to - from);
  const double seconds = change <= acceleration_ * acceleration_ / jerk_
                             ? 2.0 * std::sqrt(change / jerk_)
                             : change / acceleration_ + acceleration_ / jerk_;
  return 0.5 * (from + to) * seconds;  // the S-curve is symmetric about its middle
}

double SpeedLaw::reachable_speed(double from, double length, double cap) const {
  if (cap <= from) return cap;  // slowing down is considered from the other end
  return last_that_keeps(from, cap, [&](double to) { return change_length(from, to) <= length; });
}

void SpeedLaw::add(double seconds, double jerk) {
  const double begin = duration_s();
  phases_.push_back({begin, begin + seconds, arc_, speed_, rate_, jerk});
  arc_ += seconds * (speed_ + seconds * (rate_ / 2.0 + seconds * jerk / 6.0));
  speed_ += seconds * (rate_ + seconds * jerk / 2.0);
  rate_ += seconds * jerk;
}

void SpeedLaw::change_speed(double to) {
  const double change = std::abs(to - speed_);
  if (change <= 0.0) return;
  const double jerk = to > speed_ ? jerk_ : -jerk_;
  if (change <= acceleration_ * acceleration_ / jerk_) {
    const double half = std::sqrt(change / jerk_);
    add(half, jerk);
    add(half, -jerk);
  } else {
    const double rise = acceleration_ / jerk_;
    add(rise, jerk);
    add(change / acceleration_ - rise, 0.0);
    add(rise, -jerk);
  }
  rate_ = 0.0;  // or else rounding would accumulate
  speed_ = to;
}

const SpeedLaw::Phase& SpeedLaw::phase_at(double time_s) const {
  const auto after = std::upper_bound(phases_.begin() + 1, phases_.end(), time_s,
                                      [](double time, const Phase& phase) { return time < phase.begin_s; });
  return *(after - 1);
}

double SpeedLaw::arc_mm(double time_s) const {
  if (phases_.empty() || time_s <= 0.0) return 0.0;
  if (time_s >= duration_s()) return length_mm_;
  const Phase& p = phase_at(time_s);
  const double t = time_s - p.begin_s;
  return std::min(length_mm_,
                  p.arc_mm + t * (p.speed_mm_s + t * (p.acceleration_mm_s2 / 2.0 + t * p.jerk_mm_s3 / 6.0)));
}

double SpeedLaw::speed_mm_s(double time_s) const {
  if (phases_.empty() || time_s <= 0.0 || time_s >= duration_s()) return 0.0;
  const Phase& p = phase_at(time_s);
  const double t = time_s - p.begin_s;
  return std::max(0.0, p.speed_mm_s + t * (p.acceleration_mm_s2 + t * p.jerk_mm_s3 / 2.0));
}

double SpeedLaw::time_s(double arc) const {
  if (arc <= 0.0) return 0.0;
  if (arc >= length_mm_) return duration_s();
  return last_that_keeps(0.0, duration_s(), [&](double time) { return arc_mm(time) <= arc; });
}

}  // namespace incise::robot_detail
