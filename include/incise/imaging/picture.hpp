#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
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

/// Decodes a `.png`, `.jpg` or `.tif` held in memory. 16-bit channels are rounded to 8; a transparent pixel is laid on
/// white; the orientation that a camera wrote into a JPEG is applied.
/// @param bytes  the whole file.  @param name  stands for the file in messages.
/// @throws DataError for another format, a file that is cut short or damaged, pixels that it states not to be square,
/// grey or CMYK pictures, a picture whose channels are all equal (no colour to see), more than 200 million pixels, or
/// more than its bytes can hold.
[[nodiscard]] ColorPicture decode_picture(std::string_view bytes, const std::filesystem::path& name);

/// Decodes a depth picture: one channel of 16 bits (`.png`, `.tif`). @throws DataError as decode_picture, for another
/// depth or number of channels, and where every pixel is 0.
[[nodiscard]] DepthPicture decode_depth(std::string_view bytes, const std::filesystem::path& name);

/// A PNG file in memory. @pre rgb.size() == 3 * width * height, width and height > 0.
[[nodiscard]] std::string encode_png(const ColorPicture& picture);
[[nodiscard]] std::string encode_png(const DepthPicture& picture);
/// A JPEG file in memory, chroma at half resolution as cameras write it. @param quality  [1, 100]. @pre as encode_png.
[[nodiscard]] std::string encode_jpeg(const ColorPicture& picture, int quality);

}  // namespace incise
