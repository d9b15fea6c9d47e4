#pragma once

#include <incise/robot/program_audit.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise::cli {

/// Whether a program is the one that was checked: `checked`, `digest_matches` (null: it carries none), what its header
/// says wrongly, what could not be made again, which limits options moved, and its verdict as its header says.
[[nodiscard]] nlohmann::ordered_json audit_json(const ProgramAudit& audit, const ProgramHeader& header);

/// Writes `replay.svg`, where the program cuts, into a folder. @throws DataError
void write_replay_figure(const std::filesystem::path& folder, const Replay& replay);

}  // namespace incise::cli
