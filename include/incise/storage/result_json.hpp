#pragma once

#include <incise/core/described_json.hpp>
#include <incise/workflow/products.hpp>
#include <incise/workflow/study.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise {

/// What a person wants of it: method, outcome, floor, passes without their waypoints.
[[nodiscard]] nlohmann::ordered_json correction_summary_json(const Correction& correction);
[[nodiscard]] nlohmann::ordered_json plan_summary_json(const ToolPath& path);

}  // namespace incise
