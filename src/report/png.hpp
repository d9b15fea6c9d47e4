#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace incise {

/// A PNG file, in memory, of rows from the top. `channels`: 1 (grey) or 3 (RGB), 8 bits each.
/// @pre pixels.size() == width * height * channels.
[[nodiscard]] std::string encoded_png(std::span<const std::uint8_t> pixels, int width, int height, int channels);

[[nodiscard]] std::string png_data_uri(std::string_view png);

}  // namespace incise
