#pragma once

#include <span>
#include <string_view>

namespace incise::studio {

/// A file of the page, embedded when this is built.
struct PageFile {
  std::string_view name;  ///< "index.html", "app.js", "lib/three.module.min.js"
  std::string_view content;
};
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace incise::studio
