#pragma once

#include <filesystem>
#include <iterator>

namespace incise::testing {

/// The least manifest.json that marks a folder as a result of incise.
inline constexpr const char* kManifest = R"({"version": "1", "commit": "c", "command": "incise test", "settings": {}})";

inline std::size_t entries_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace incise::testing
