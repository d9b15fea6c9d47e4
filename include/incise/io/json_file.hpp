#pragma once

#include <incise/core/json_text.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace incise {

/// Writes json_text(value) to a file, all or nothing.
/// @throws DataError if it cannot be written; InvalidArgument as json_text.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& value);

/// Reads and parses a JSON file. @throws DataError as parse_json, or if the file cannot be read.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& path);

}  // namespace incise
