#pragma once

#include <incise/cutting/incision.hpp>

#include <filesystem>

namespace incise {

/// Writes the kerf's files beside `incision.json`: depth.csv and, as far as they were measured, kerf.vtp,
/// centerline_DEPTHmm.csv, lag.csv, centerline_final.csv, inner_edge_reference.csv.
void write_kerf_files(const std::filesystem::path& folder, const KerfMeasures& kerf);

}  // namespace incise
