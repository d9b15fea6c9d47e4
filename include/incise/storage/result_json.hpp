#pragma once

#include <incise/core/described_json.hpp>
#include <incise/workflow/products.hpp>
#include <incise/workflow/study.hpp>

#include <nlohmann/json.hpp>

namespace incise {

/// Returns a correction as JSON without its values by waypoint.
[[nodiscard]] nlohmann::ordered_json correction_summary_json(const Correction& correction);
/// Returns a path's length_mm, number of waypoints, duration_s and whether it is closed.
[[nodiscard]] nlohmann::ordered_json plan_summary_json(const ToolPath& path);

}  // namespace incise
