#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// JSON text, indented by two, ending in a line end. Other writers turn NaN into `null` without a word; this one
/// refuses.
/// @throws InvalidArgument with the JSON pointer of the first number that is not finite.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& value);

/// Writes json_text to a file, all or nothing. @throws DataError if it cannot be written; InvalidArgument as json_text.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& value);

/// Parses JSON, key order kept. @param name stands for the file in messages.
/// @throws DataError with line and column where the text is not JSON; a key given twice in one object is refused, too.
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text, const std::filesystem::path& name);

/// Reads and parses a file. @throws DataError as parse_json, or if the file cannot be read.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& path);

}  // namespace incise
