#pragma once

#include <incise/geometry/picture.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace incise {

/// Decodes a `.png`, `.jpg` or `.tif` held in memory. Rounds 16-bit channels to 8 bits, blends transparent pixels with
/// white, and applies the orientation stored in a JPEG or TIFF; ignores gamma and colour profiles.
/// @param bytes  the whole file, at most 1 GiB  @param name  names the file in messages
/// @throws DataError for another format, a truncated or damaged file, non-square pixels (as stated in the file), grey
///         or CMYK pictures, a picture without colour (the channels differ by at most 8 at every pixel), more than 200
///         million pixels, or more pixels than its bytes can hold.
[[nodiscard]] ColorPicture decode_picture(std::string_view bytes, const std::filesystem::path& name);

/// Decodes a depth picture: one channel of 16 bits (`.png`, `.tif`); applies the orientation stored in a TIFF.
/// @throws DataError as decode_picture, but here for any other number of channels or bits, and if every pixel is 0.
[[nodiscard]] DepthPicture decode_depth(std::string_view bytes, const std::filesystem::path& name);

/// Returns the bytes of a PNG file: RGB of 8 bits, or grey of 16.
/// @pre width * height pixels, both > 0 (InvalidArgument).
[[nodiscard]] std::string encode_png(const ColorPicture& picture);
[[nodiscard]] std::string encode_png(const DepthPicture& picture);
/// The same for pixels of 8 bits per channel, rows from the top. @param channels  1 (grey) or 3 (RGB)
/// @pre pixels.size() == width * height * channels (InvalidArgument).
[[nodiscard]] std::string encode_png(std::span<const std::uint8_t> pixels, int width, int height, int channels);

}  // namespace incise
