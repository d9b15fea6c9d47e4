#pragma once

#include <incise/cutting/incision.hpp>

#include <filesystem>

namespace incise {

/// Writes what goes beside `incision.json`: kerf.vtp, centerline_DEPTHmm.csv, depth.csv, lag.csv, centerline_final.csv,
/// inner_edge_reference.csv.
void write_kerf_files(const std::filesystem::path& folder, const KerfMeasures& kerf);

}  // namespace incise
