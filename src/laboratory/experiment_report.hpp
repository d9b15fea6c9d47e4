#pragma once

#include "laboratory/experiment_rivals.hpp"

#include <incise/report/report_data.hpp>

namespace incise::laboratory {

/// The page with everything: tables, the comparison's figures, the calibration's, the paper's figures cited beside.
/// @param folder  of the experiment: figures are taken from there where they are.
[[nodiscard]] ReportData experiment_report(const std::vector<Trial>& trials, const PathComparison& paths,
                                           const nlohmann::ordered_json& result, const std::filesystem::path& folder);

}  // namespace incise::laboratory
