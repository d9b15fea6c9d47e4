#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace incise::imaging_detail {

/// Looks through the structure of a picture file before a decoder does, because decoders fill what is missing with
/// grey and turn CMYK into RGB without a word.
/// @throws DataError for a format other than PNG, JPEG and TIFF, a file that ends too early or whose checksums do not
/// match, CMYK, more than 200 million pixels, more pixels than its bytes can hold, no pixels.
void require_whole_picture(std::string_view bytes, const std::filesystem::path& name);

/// Reads every coefficient of a JPEG file. @throws DataError for damage within the picture, which decoders paint over.
void require_sound_jpeg(std::string_view bytes, const std::filesystem::path& name);

inline constexpr double kMostPixels = 2e8;
inline constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // decoders count bytes in 31 bits

}  // namespace incise::imaging_detail
