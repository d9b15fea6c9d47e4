#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/tool_path.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// Reads a tool path (`path.json`), strictly. Keys:
///
///   schema             "incise.path/1"; optional
///   frame              sim_rest | sim_stretched | robot
///   kind               incise | mark
///   closed             true | false
///   waypoints          [{position_mm: [x, y, z], axis: [x, y, z] (unit to 1e-4), depth_mm: >= 0, speed_mm_s: > 0}],
///                      at least 3 (2 if open)
///   tumor_edge         [[x, y, z]…], mm, same frame; optional
///   tumor_edge_closed  optional, by default true
///   T_robot_sim        4 x 4 similarity by rows, last row 0 0 0 1, mm; optional
///   source_sha256      64 lower-case hex digits; optional
///   specimen_id        the specimen that the path was planned on (specimen_id.hpp); optional
///   specimen_is        real | virtual; optional
///   verdict            on the simulated cut along the path, see read_path_verdict; optional, not checked here
///
/// @throws DataError with a JSON pointer to the place: unknown key (naming the nearest valid one), key given twice,
///         missing key, wrong type, number out of range, text that is not JSON (line and column).
[[nodiscard]] ToolPath read_tool_path(const std::filesystem::path& path);

/// Checks that the path's tumour edge has a size that a tumour can have. A path without an edge passes.
/// @throws DataError naming the file.
void require_tumor_size(const ToolPath& path, const std::filesystem::path& file);

/// Parses a path from JSON text. @param name  names the file in messages. @throws DataError as read_tool_path.
[[nodiscard]] ToolPath tool_path_from_json(std::string_view text, const std::filesystem::path& name);

/// Returns the JSON text of a path; reading it back gives the same doubles.
/// @pre the path passes the checks of read_tool_path (InvalidArgument with the same message).
[[nodiscard]] std::string path_json(const ToolPath& path);

/// Writes `path.json`, all or nothing. @throws DataError if the file cannot be written; InvalidArgument as path_json.
void write_tool_path(const std::filesystem::path& file, const ToolPath& path);

/// The same, with the verdict on the simulated cut along the path and, under `verdict.digest_sha256`, a digest of both.
void write_tool_path(const std::filesystem::path& file, const ToolPath& path, const Verdict& verdict);

/// Returns the verdict in a path's file. If the file has none, or if its path or verdict has changed since it was
/// written (the digest differs), returns a caution `not_simulated` that says which; after a change, the refusals of the
/// stored verdict remain too.
/// @throws DataError as read_tool_path, or if the verdict is damaged.
[[nodiscard]] Verdict read_path_verdict(const std::filesystem::path& file);

}  // namespace incise
