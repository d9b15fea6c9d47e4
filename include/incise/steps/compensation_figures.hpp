#pragma once

#include <incise/report/line_plot.hpp>
#include <incise/report/report_data.hpp>

#include <filesystem>
#include <vector>

namespace incise::steps {

/// A figure of the correction and the name of its file.
struct CompensationFigure {
  const char* file;
  LinePlot plot;
};

/// Returns the figures of the correction in a run's folder: error along the path, pass by pass; mean error against the
/// pass; with a robust path, the offsets of its waypoints. Empty: no correction, one without passes, or no error of the
/// first cut. @throws DataError for a damaged file.
[[nodiscard]] std::vector<CompensationFigure> compensation_figures(const std::filesystem::path& root);

/// Returns mean and greatest error, error averaged along the path, and greatest move, pass by pass. No rows: no
/// correction, or one without passes.
[[nodiscard]] ReportTable compensation_table(const std::filesystem::path& root);

/// Writes the figures to `folder`, which is created. @returns the paths of the files.
std::vector<std::filesystem::path> write_compensation_figures(const std::filesystem::path& root,
                                                              const std::filesystem::path& folder);

}  // namespace incise::steps
