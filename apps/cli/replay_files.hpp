#pragma once

#include <incise/robot/player.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace incise::cli {

/// The numbers of a replay.
[[nodiscard]] nlohmann::ordered_json to_json(const Replay& replay, const PlayerSettings& settings);

/// Writes `true_path.csv` and, where the program cuts, `replay.svg` into a folder. @throws DataError
void write_replay(const std::filesystem::path& folder, const Replay& replay);

}  // namespace incise::cli
