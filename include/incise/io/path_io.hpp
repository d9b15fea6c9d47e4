#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/tool_path.hpp>

#include <filesystem>
#include <optional>
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
///   specimen_id    of the specimen that the path was planned on (specimen_id.hpp); optional
///   specimen_is    real | virtual; optional
///   verdict        of the simulated cut along the path, see read_path_verdict; optional
///
/// @throws DataError with the JSON pointer of the place: unknown key (naming the nearest valid one), key given twice,
/// missing key, wrong
///         type, number out of range, text that is not JSON (line and column).
[[nodiscard]] ToolPath read_tool_path(const std::filesystem::path& path);

/// Refuses a path whose tumour edge is no tumour's: smaller or larger across than one can be. A path without an edge passes.
/// @throws DataError naming the file.
void require_tumor_size(const ToolPath& path, const std::filesystem::path& file);

/// As read_tool_path, from memory. @param name  stands for the file in messages.
[[nodiscard]] ToolPath tool_path_from_json(std::string_view text, const std::filesystem::path& name);

/// The JSON text of a path; reading it back gives the same doubles. @pre the path keeps the rules that reading checks
/// (else InvalidArgument with the same words).
[[nodiscard]] std::string path_json(const ToolPath& path);

/// Writes `path.json`, all or nothing. @throws DataError if the file cannot be written; InvalidArgument as path_json.
void write_tool_path(const std::filesystem::path& file, const ToolPath& path);

/// The same with the verdict of the simulated cut along the path, and a digest over both under `verdict.digest_sha256`.
void write_tool_path(const std::filesystem::path& file, const ToolPath& path, const Verdict& verdict);

/// The verdict that a path's file holds. A file without one, and one whose path or verdict was changed since (the
/// digest differs), gives a caution `not_simulated` that says which: whatever was simulated, it was not this path. What
/// a changed file's verdict refuses stays refused.
/// @throws DataError as read_tool_path, and where the verdict is damaged.
[[nodiscard]] Verdict read_path_verdict(const std::filesystem::path& file);

/// @throws DataError where the file holds a verdict and a digest that is not of this path and verdict: it was changed
/// after it was written.
void require_path_unchanged(const std::filesystem::path& file);

}  // namespace incise
