#pragma once

#include <incise/report/report_data.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace incise {

/// A point or direction as JSON: [x, y, z].
[[nodiscard]] nlohmann::ordered_json json_of(const Vec3& v);

/// The animations as JSON for the page's script. Positions are 16-bit steps within one box per animation (a step is
/// 1/65535 of the box, some micrometres); vertices that no skin uses are left out; numbers are little endian, as
/// base64. {name, low: [3], step_mm: [3], vertices: V, index_bytes: 2|4, frames: [{time_s, phase, positions, outer,
/// kerf, tip?, axis}],
///  lines: [{label, color, closed, points: [...]}], tool: {diameter_mm, length_mm}, total_frames}
/// @param budget  bytes of base64 that one animation may take. If all frames need more, evenly spaced ones are kept,
/// with the first and the last.
[[nodiscard]] nlohmann::ordered_json animation_json(const ReportAnimation& animation, std::size_t budget);

/// The mesh as JSON, same encoding: {low, step_mm, vertices, index_bytes, positions, tets, tet_count}.
[[nodiscard]] nlohmann::ordered_json mesh_json(const TetMesh& mesh);

/// Returns JSON text for use inside an HTML script element: it contains no "<".
[[nodiscard]] std::string script_json(const nlohmann::ordered_json& value);

}  // namespace incise
