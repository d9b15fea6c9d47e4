#pragma once

#include <incise/robot/program_audit.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise::cli {

/// The numbers of a replay.
[[nodiscard]] nlohmann::ordered_json to_json(const Replay& replay, const PlayerSettings& settings);

/// Whether a program is the one that was checked: `checked`, `digest_matches` (null: it carries none), what its header
/// says wrongly, what could not be made again, which limits options moved, and its verdict as its header says.
[[nodiscard]] nlohmann::ordered_json to_json(const ProgramAudit& audit, const ProgramHeader& header);

/// Writes `true_path.csv` and, where the program cuts, `replay.svg` into a folder. @throws DataError
void write_replay(const std::filesystem::path& folder, const Replay& replay);

}  // namespace incise::cli
