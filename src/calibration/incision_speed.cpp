#include <incise/calibration/incision_speed.hpp>
#include <incise/core/error.hpp>
#include <incise/evaluation/statistics.hpp>

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace incise {
namespace {

double one_speed(const TimedCut& cut, std::size_t number) {
  INCISE_REQUIRE(std::isfinite(cut.length_mm) && cut.length_mm > 0.0,
                 fmt::format("cut {}: expected a length above 0 mm, found {}", number, cut.length_mm));
  INCISE_REQUIRE(std::isfinite(cut.time_s) && cut.time_s > 0.0,
                 fmt::format("cut {}: expected a time above 0 s, found {}", number, cut.time_s));
  return cut.length_mm / cut.time_s;
}

/// Rounds to a speed that a person would set.
double rounded_speed(double speed_mm_s) {
  const double digit = speed_mm_s >= 1.0 ? 1.0 : std::pow(10.0, std::floor(std::log10(speed_mm_s)));
  return std::round(speed_mm_s / digit) * digit;
}

}  // namespace

SpeedEstimate estimate_speed(std::span<const TimedCut> cuts) {
  INCISE_REQUIRE(!cuts.empty(), "expected at least one timed cut, found none");
  std::vector<double> speeds;
  for (const TimedCut& cut : cuts) speeds.push_back(one_speed(cut, speeds.size() + 1));
  const Summary summary = summarize(speeds);
  const auto count = static_cast<double>(speeds.size());
  SpeedEstimate estimate;
  estimate.cuts = speeds.size();
  estimate.mean_mm_s = summary.mean;
  estimate.min_mm_s = summary.min;
  estimate.max_mm_s = summary.max;
  if (speeds.size() > 1) estimate.sample_sd_mm_s = summary.sd;
  estimate.population_sd_mm_s = summary.sd * std::sqrt((count - 1.0) / count);
  estimate.recommended_mm_s = rounded_speed(summary.mean);
  return estimate;
}

}  // namespace incise
