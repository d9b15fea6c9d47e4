#pragma once

#include "io/volume_itk.hpp"

#include <filesystem>

namespace incise {

/// Most pixels of one slice: 32768 x 32768, far above any scanner's.
inline constexpr double kMostPicturePixels = 1073741824.0;

/// Reads a gray PNG picture of 8 or 16 bits, as it is: no gamma, no background, no scaling. size[2] is 1, spacing 1 mm.
/// @throws DataError for anything else, and for a picture that is damaged or that claims more pixels than its bytes can hold.
/// Source: PNG specification (W3C), 5.2 to 5.5 and 11.2.2.
[[nodiscard]] RawImage read_gray_png(const std::filesystem::path& file);

}  // namespace incise
