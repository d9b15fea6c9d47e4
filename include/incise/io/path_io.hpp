#pragma once

#include <incise/geometry/tool_path.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// Reads a tool path (`path.json`), strictly. Keys:
///
///   schema         "incise.path/1"; optional
///   frame          sim_rest | sim_stretched | robot
///   kind           incise | mark
///   closed         true | false
///   waypoints      [{position_mm: [x, y, z], axis: [x, y, z] (unit to 1e-4), depth_mm: >= 0, speed_mm_s: > 0}], at
///   least 3 (2 if open) tumor_edge     [[x, y, z]…], same frame; optional tumor_edge_closed  optional, true
///   T_robot_sim    4 x 4, rows, last row 0 0 0 1; optional
///   source_sha256  64 hex digits; optional
///
/// @throws DataError with the JSON pointer of the place: unknown key (naming the nearest valid one), key given twice,
/// missing key, wrong
///         type, number out of range, text that is not JSON (line and column).
[[nodiscard]] ToolPath read_tool_path(const std::filesystem::path& path);

/// As read_tool_path, from memory. @param name  stands for the file in messages.
[[nodiscard]] ToolPath tool_path_from_json(std::string_view text, const std::filesystem::path& name);

/// The JSON text of a path; reading it back gives the same doubles. @pre the path keeps the rules that reading checks
/// (else InvalidArgument with the same words).
[[nodiscard]] std::string to_json(const ToolPath& path);

/// Writes `path.json`, all or nothing. @throws DataError if the file cannot be written; InvalidArgument as to_json.
void write_tool_path(const std::filesystem::path& file, const ToolPath& path);

}  // namespace incise
