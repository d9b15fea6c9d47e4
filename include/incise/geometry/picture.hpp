#pragma once

#include <cstdint>
#include <vector>

namespace incise {

/// A colour picture: rows from the top, sRGB, 8 bits a channel. Pixel (u, v) = (column, row) has its centre at (u, v).
struct ColorPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height
};

/// A depth picture as a camera delivers it: rows from the top, one count a pixel, 0 = nothing measured.
struct DepthPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> counts;  ///< width * height
};

}  // namespace incise
