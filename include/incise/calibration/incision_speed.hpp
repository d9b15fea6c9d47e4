#pragma once

#include <incise/core/describe.hpp>

#include <cstddef>
#include <optional>
#include <span>

namespace incise {

/// Plausible lengths of a timed straight cut, mm, and plausible cutting speeds, mm/s.
inline constexpr double kShortestTimedCutMm = 1.0, kLongestTimedCutMm = 2000.0;
inline constexpr double kSlowestCutMmS = 0.5, kFastestCutMmS = 50.0;

/// One straight cut by a surgeon, timed.
struct TimedCut {
  double length_mm = 0.0;  ///< > 0
  double time_s = 0.0;     ///< > 0
};

/// Cutting speed of a surgeon.
struct SpeedEstimate {
  std::size_t cuts = 0;
  double mean_mm_s = 0.0;  ///< mean of the cuts' speeds; each cut counts once, whatever its length
  double min_mm_s = 0.0, max_mm_s = 0.0;
  std::optional<double> sample_sd_mm_s;  ///< divided by n - 1; absent for a single cut
  double population_sd_mm_s = 0.0;       ///< divided by n: what the paper prints
  double recommended_mm_s = 0.0;         ///< the mean rounded to a whole mm/s; below 1 mm/s to one significant digit
};
inline void describe(Visitor& v, SpeedEstimate& e) {
  v("cuts", e.cuts, "Number of cuts.");
  v({"mean_mm_s", "Mean of the cuts' speeds; each cut counts once, whatever its length.", "mm/s"}, e.mean_mm_s);
  v({"sample_sd_mm_s", "Standard deviation, divided by n - 1; absent for a single cut.", "mm/s"}, e.sample_sd_mm_s);
  v({"population_sd_mm_s", "Standard deviation, divided by n, as the paper prints it.", "mm/s"}, e.population_sd_mm_s);
  v({"min_mm_s", "Speed of the slowest cut.", "mm/s"}, e.min_mm_s);
  v({"max_mm_s", "Speed of the fastest cut.", "mm/s"}, e.max_mm_s);
  v({"recommended_mm_s", "The mean rounded to a whole mm/s; below 1 mm/s to one digit.", "mm/s"}, e.recommended_mm_s);
}

/// Estimates a surgeon's speed from timed straight cuts.
/// @throws InvalidArgument without cuts, or naming the first cut whose length or time is not above 0.
/// Source: [Paper, II-B.1]: six cuts of 10 cm, 7.22 ± 1.89 mm/s, rounded to 7.
[[nodiscard]] SpeedEstimate estimate_speed(std::span<const TimedCut> cuts);

}  // namespace incise
