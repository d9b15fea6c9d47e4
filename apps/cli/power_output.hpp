#pragma once

#include "options.hpp"

#include <incise/bench_studies/power_series.hpp>
#include <incise/calibration/incision_speed.hpp>

#include <optional>

namespace incise::cli {

/// What `incise power` found.
struct PowerResult {
  std::vector<PowerSubject> subjects;
  PowerRequest request;
  PowerSeries series;
  std::optional<SpeedEstimate> speed;  ///< of the timed cuts, where there are some
  double wall_s = 0.0;
};

/// The content of `power.json` and of --json.
[[nodiscard]] nlohmann::ordered_json json_of(const PowerResult& result);

/// Fills the output folder: power.csv, bulge.svg and heat.svg against the power, speed.svg against the speed where
/// speeds were asked for, manifest.json, and power.json last.
void write_power(const std::filesystem::path& folder, const PowerResult& result,
                 const std::vector<std::filesystem::path>& inputs, const CommonOptions& options);

/// With --json the one object, else a table for a person.
void print_power(const CommonOptions& options, const PowerResult& result, const std::filesystem::path& folder);

/// The speed of the timed cuts, for a person.
void print_speed(const SpeedEstimate& speed);

}  // namespace incise::cli
