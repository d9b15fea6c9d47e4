#pragma once

#include <incise/core/monitor.hpp>
#include <incise/report/report_data.hpp>

#include <filesystem>

namespace incise::cli {

/// Gathers what a study's folder holds for its report; what is not there (yet) is left out and the page says so.
/// @throws DataError if the folder is no study (no study.json) or a file in it is damaged.
[[nodiscard]] ReportData study_report(const std::filesystem::path& root, Monitor& monitor);

/// Writes report.html, and beside it figures/: contours.svg (as planned), contours_corrected.svg, error_by_angle.svg, box_plot.svg,
/// kerf_depth.svg, kerf_lag.svg, kerf_drift.svg, kerf.svg, kerf_corrected.svg, cut.png and, with legend and scale bar, cut.svg (the last moment
/// of the last cut), those that the data allow.
/// @throws DataError if something cannot be written.
void write_report_and_figures(const ReportData& data, const std::filesystem::path& page);

}  // namespace incise::cli
