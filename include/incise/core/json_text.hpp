#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// What is read at most of one JSON file.
inline constexpr std::uint64_t kLargestJsonBytes = 256ULL << 20;

/// JSON text, indented by two, ending in a line end. Other writers turn NaN into `null` without a word; this one
/// refuses.
/// @throws InvalidArgument with the JSON pointer of the first number that is not finite.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& value);

/// Parses JSON, key order kept. @param name stands for the file in messages.
/// @throws DataError with line and column where the text is not JSON; for a key given twice in one object, values
/// nested more than 64 deep, an object of more than 5000 keys, more than kLargestJsonBytes.
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text, const std::filesystem::path& name);

}  // namespace incise
