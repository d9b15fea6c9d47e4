#pragma once

#include <incise/core/error.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Takes values out of a JSON file that incise wrote: what `read` returns.
/// @throws DataError naming the file where a key is missing or a value is of another kind, as in a file that was
/// changed.
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
