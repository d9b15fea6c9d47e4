#pragma once

#include <filesystem>
#include <string_view>

namespace incise::imaging_detail {

/// Looks through the structure of a picture file before a decoder does, because decoders fill what is missing with
/// grey and turn CMYK into RGB without a word.
/// @throws DataError for a format other than PNG, JPEG and TIFF, a file that ends too early, CMYK.
void require_whole_picture(std::string_view bytes, const std::filesystem::path& name);

}  // namespace incise::imaging_detail
