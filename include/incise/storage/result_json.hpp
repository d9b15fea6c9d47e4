#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/planning/compensation.hpp>
#include <incise/workflow/products.hpp>
#include <incise/workflow/study.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise {

/// Results as the JSON objects that files and `--json` hold; keys carry units and what was not measured is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Evaluation& evaluation);
[[nodiscard]] nlohmann::ordered_json to_json(const SimulatedCut& cut);
[[nodiscard]] nlohmann::ordered_json to_json(const MeshQuality& quality);
[[nodiscard]] nlohmann::ordered_json to_json(const MeshingResult& meshing);
[[nodiscard]] nlohmann::ordered_json to_json(const Segmentation& segmentation);
[[nodiscard]] nlohmann::ordered_json to_json(const StaticResult& result);
[[nodiscard]] nlohmann::ordered_json to_json(const Correction& correction);
/// What a person wants of it: method, outcome, floor, passes without their waypoints.
[[nodiscard]] nlohmann::ordered_json correction_summary_json(const Correction& correction);
[[nodiscard]] nlohmann::ordered_json plan_summary_json(const ToolPath& path);
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<StageReport>& stages);

/// The outcome that a result file names under `key`. @throws DataError naming the file for a name that is none.
[[nodiscard]] Outcome read_outcome(const nlohmann::ordered_json& json, const char* key, const std::filesystem::path& file);

}  // namespace incise
