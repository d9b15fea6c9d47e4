#pragma once

#include <span>
#include <string_view>

namespace incise {

/// A text file that the build embeds in the program (incise_embed in cmake/InciseTargets.cmake).
struct EmbeddedFile {
  std::string_view name;     ///< "index.html", "lib/three.core.js"
  std::string_view content;  ///< UTF-8
};

/// Returns the file called `name`, or null if there is none. O(files).
[[nodiscard]] inline const EmbeddedFile* find_embedded(std::span<const EmbeddedFile> files, std::string_view name) {
  for (const EmbeddedFile& file : files) {
    if (file.name == name) return &file;
  }
  return nullptr;
}

}  // namespace incise
