#pragma once

#include "io/volume_itk.hpp"

#include <filesystem>

namespace incise {

/// Most pixels of one slice: 32768 x 32768, far above any scanner's.
inline constexpr double kMostPicturePixels = 1073741824.0;

/// Reads a gray PNG picture of 8 or 16 bits unchanged: no gamma, no background, no scaling. size[2] is 1, spacing 1 mm.
/// @throws DataError for anything else, and as read_png.
[[nodiscard]] RawImage read_gray_png(const std::filesystem::path& file);

}  // namespace incise
