#pragma once

#include "laboratory/experiment_rivals.hpp"

#include <incise/report/report_data.hpp>

namespace incise::laboratory {

/// Returns the content of the report page: tables, figures of the comparison and of the calibration, and the paper's
/// numbers, cited.
/// @param folder  of the experiment; figures are read from it if they exist.
[[nodiscard]] ReportData experiment_report(const std::vector<Trial>& trials, const PathComparison& paths,
                                           const nlohmann::ordered_json& result, const std::filesystem::path& folder);

}  // namespace incise::laboratory
