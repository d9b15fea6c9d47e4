#pragma once

#include <filesystem>
#include <vector>

namespace incise::testing {

/// An 8-bit grey picture, row by row from the top.
struct PngSlice {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> grey;
};

/// Plain types only: ITK's readers bring another Eigen with them, which cannot meet ours in one source.
[[nodiscard]] PngSlice read_png_slice(const std::filesystem::path& file);

}  // namespace incise::testing
