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

/// Error along the path, pass by pass, and mean error against the pass, from what a study's folder holds. Empty: no
/// correction, or one without passes. @throws DataError for a damaged file.
[[nodiscard]] std::vector<CompensationFigure> compensation_figures(const std::filesystem::path& root);

/// Pass by pass: mean, greatest and correctable error, greatest move. No rows: as above.
[[nodiscard]] ReportTable compensation_table(const std::filesystem::path& root);

/// Writes the figures to `folder`, which is made. @returns the paths of the files.
std::vector<std::filesystem::path> write_compensation_figures(const std::filesystem::path& root,
                                                              const std::filesystem::path& folder);

}  // namespace incise::steps
