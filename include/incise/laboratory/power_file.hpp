#pragma once

#include <incise/bench_studies/power_series.hpp>
#include <incise/calibration/incision_speed.hpp>
#include <incise/io/table_io.hpp>

#include <filesystem>
#include <vector>

namespace incise {

/// Returns a table with one row per cut. The column `series` says to which series a cut belongs, power or speed. A
/// quantity that was not measured is an empty field.
[[nodiscard]] TextTable power_table(const PowerSeries& series);

/// Reads timed straight cuts: a CSV file with the columns length_mm (1 to 2000) and time_s, with speeds of 0.5 to
/// 50 mm/s.
/// @throws DataError naming line and column, or for a file without rows.
[[nodiscard]] std::vector<TimedCut> read_timed_cuts(const std::filesystem::path& file);

}  // namespace incise
