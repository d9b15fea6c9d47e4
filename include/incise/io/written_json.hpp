#pragma once

#include <incise/core/error.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Returns the result of `read`, which takes values out of a JSON file that incise wrote.
/// @throws DataError naming the file if a key is missing or a value has another type, as in a file that was changed.
template <class Read>
auto from_written_json(const std::filesystem::path& file, const Read& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    std::string found = error.what();
    if (const auto end = found.find("] "); found.starts_with("[json.exception") && end != std::string::npos)
      found.erase(0, end + 2);
    throw DataError(file, "", found, "the file as incise wrote it", "Run the stage that wrote it again.");
  }
}

}  // namespace incise
