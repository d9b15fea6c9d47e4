#pragma once

#include <incise/bench_studies/power_series.hpp>
#include <incise/calibration/incision_speed.hpp>
#include <incise/io/table_io.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// All cuts, one a row; the column `series` says which of the two they belong to, power or speed. What was not measured
/// is an empty field.
[[nodiscard]] TextTable power_table(const PowerSeries& series);

/// Reads timed straight cuts: a CSV with the columns length_mm (1 to 2000) and time_s, at 0.5 to 50 mm/s.
/// @throws DataError naming line and column.
[[nodiscard]] std::vector<TimedCut> read_timed_cuts(const std::filesystem::path& file);

}  // namespace incise
