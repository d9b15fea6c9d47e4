#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace incise {

/// A PNG file in memory: 8 bits, 3 channels. @pre pixels.size() == 3 * width * height
[[nodiscard]] std::string png_of_colors(std::span<const std::uint8_t> pixels, int width, int height);
/// 16 bits, 1 channel, counts as they are. @pre counts.size() == width * height
[[nodiscard]] std::string png_of_counts(std::span<const std::uint16_t> counts, int width, int height);

}  // namespace incise
