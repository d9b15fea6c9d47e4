#pragma once

#include <incise/core/monitor.hpp>
#include <incise/report/report_data.hpp>

#include <filesystem>

namespace incise::steps {

/// Collects the contents of a run's folder for its report. Parts that are missing (yet) are left out, and the page says
/// so. Lengths in mm, coordinates LPS.
/// @throws DataError if the folder is not one of a run (no study.json) or a file in it is damaged; Cancelled.
[[nodiscard]] ReportData run_report(const std::filesystem::path& root, Monitor& monitor);

/// Adds figures and numbers from the folders of `register` and `replay`. An empty path: no such folder.
/// @throws DataError if a folder holds no such results.
void add_on_tissue(const std::filesystem::path& registration, const std::filesystem::path& replay, ReportData& data);

/// Writes report.html and, beside it, the figures that the data allow: figures/ with contours.svg (as planned),
/// contours_corrected.svg, error_by_angle.svg, box_plot.svg, kerf_depth.svg, kerf_lag.svg, kerf_drift.svg, kerf.svg,
/// kerf_corrected.svg, cut.png and, with legend and scale bar, cut.svg (the last moment of the last cut).
/// @throws DataError if something cannot be written.
void write_report_and_figures(const ReportData& data, const std::filesystem::path& page);

}  // namespace incise::steps
