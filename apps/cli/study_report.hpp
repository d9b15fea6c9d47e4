#pragma once

#include <incise/core/monitor.hpp>
#include <incise/report/report_data.hpp>

#include <filesystem>

namespace incise::cli {

/// Gathers what a study's folder holds for its report; what is not there (yet) is left out and the page says so.
/// @throws DataError if the folder is no study (no study.json) or a file in it is damaged.
[[nodiscard]] ReportData study_report(const std::filesystem::path& root, Monitor& monitor);

}  // namespace incise::cli
