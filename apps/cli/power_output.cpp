#include "power_output.hpp"

#include <fmt/format.h>

namespace incise::cli {
namespace {

std::string mm_or_dash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : std::string("-");
}

}  // namespace

void print_power(const laboratory::PowerResult& result, const std::filesystem::path& folder) {
  if (result.speed) print_speed(*result.speed);
  fmt::print("{}\n{:>8} {:>12} {:>12}\n", laboratory::kVirtualCuts, "W", "bulge, mm", "heat, mm");
  for (const PowerVerdict& verdict : result.series.choice.powers) {
    const std::string against = verdict.reasons.empty() ? "fits" : verdict.reasons.front();
    fmt::print("{:>8} {:>12} {:>12}   {}\n", verdict.power_w, mm_or_dash(verdict.greatest_bulge_mm),
               mm_or_dash(verdict.greatest_thermal_width_mm), against);
    for (std::size_t i = 1; i < verdict.reasons.size(); ++i) fmt::print("{:>36}{}\n", "", verdict.reasons[i]);
  }
  if (result.series.choice.chosen_w)
    fmt::print("chosen: {} W at {} mm/s\n", *result.series.choice.chosen_w, result.request.speed_mm_s);
  else
    fmt::print("no power fits\n");
  for (const PowerCut& cut : result.series.speed_cuts) {
    fmt::print("{:>8} mm/s   {}: bulge {} mm, heat {} mm, error {} mm, {}\n", cut.speed_mm_s, cut.specimen,
               mm_or_dash(cut.bulge_mm), mm_or_dash(cut.thermal_width_mm), mm_or_dash(cut.mean_abs_error_mm),
               to_string(cut.outcome));
  }
  fmt::print("all results: {}\n", (folder / "power.json").string());
}

void print_speed(const SpeedEstimate& speed) {
  fmt::print("{} timed cuts: {:.2f} mm/s, sd {:.2f} (n) or {} (n - 1), {:.2f} to {:.2f}; recommended {} mm/s\n",
             speed.cuts, speed.mean_mm_s, speed.population_sd_mm_s, mm_or_dash(speed.sample_sd_mm_s), speed.min_mm_s,
             speed.max_mm_s, speed.recommended_mm_s);
}

}  // namespace incise::cli
