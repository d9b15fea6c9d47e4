#pragma once

#include <incise/procedure/incision.hpp>
#include <incise/workflow/products.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise {

/// Adds the measures of the kerf to `incision.json`: kerf, live_skin, layers, depth_reached_mm, lag_mm, drift_mm,
/// deep_margin_mm.
void add_kerf_json(nlohmann::ordered_json& json, const SimulatedCut& cut);

/// Writes what goes beside it: kerf.vtp, centerline_DEPTHmm.csv, depth.csv, lag.csv, centerline_final.csv,
/// inner_edge_reference.csv.
void write_kerf_files(const std::filesystem::path& folder, const KerfMeasures& kerf);

}  // namespace incise
