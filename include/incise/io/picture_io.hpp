#pragma once

#include <incise/geometry/picture.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace incise {

/// Decodes a `.png`, `.jpg` or `.tif` held in memory. 16-bit channels are rounded to 8; a transparent pixel is laid on
/// white; the orientation stored in a JPEG or TIFF is applied; gamma and colour profiles are not.
/// @param bytes  the whole file.  @param name  stands for the file in messages.
/// @throws DataError for another format, a file that is cut short or damaged, pixels that it states not to be square,
/// grey or CMYK pictures, a picture whose channels are all equal (no colour to see), more than 200 million pixels, or
/// more than its bytes can hold.
[[nodiscard]] ColorPicture decode_picture(std::string_view bytes, const std::filesystem::path& name);

/// Decodes a depth picture: one channel of 16 bits (`.png`, `.tif`), turned as a TIFF states. @throws DataError as
/// decode_picture, for another depth or number of channels, and where every pixel is 0.
[[nodiscard]] DepthPicture decode_depth(std::string_view bytes, const std::filesystem::path& name);

/// A PNG file in memory. @pre as many pixels as width times height, both > 0.
[[nodiscard]] std::string encode_png(const ColorPicture& picture);
[[nodiscard]] std::string encode_png(const DepthPicture& picture);
/// Rows from the top, 8 bits a channel. @param channels  1 (grey) or 3 (RGB). @pre pixels.size() == width * height *
/// channels.
[[nodiscard]] std::string encode_png(std::span<const std::uint8_t> pixels, int width, int height, int channels);

}  // namespace incise
