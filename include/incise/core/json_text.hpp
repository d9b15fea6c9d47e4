#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// Largest JSON file that is read, bytes.
inline constexpr std::uint64_t kLargestJsonBytes = 256ULL << 20;

/// Returns a value as JSON text, indented by two spaces, with a newline at the end. Other writers silently turn NaN
/// into `null`; this one throws.
/// @throws InvalidArgument with the JSON pointer of the first number that is not finite.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& value);

/// Parses JSON and keeps the order of its keys. @param name  names the file in messages.
/// @throws DataError with line and column where the text is not JSON; also for a key that occurs twice in one object,
/// values nested more than 64 deep, an object of more than 5000 keys, a number beyond the range of a double, and a text
/// above kLargestJsonBytes.
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text, const std::filesystem::path& name);

}  // namespace incise
