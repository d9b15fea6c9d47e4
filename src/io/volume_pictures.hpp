#pragma once

#include "io/volume_itk.hpp"

#include <incise/io/volume_io.hpp>

#include <filesystem>

namespace incise {

/// Reads a gray PNG picture of 8 or 16 bits unchanged: no gamma, no background, no scaling. size[2] is 1, spacing 1 mm.
/// @throws DataError for anything else, and as read_png.
[[nodiscard]] RawImage read_gray_png(const std::filesystem::path& file);

/// Reads a folder of numbered gray PNG pictures as one CT. @throws as read_ct
[[nodiscard]] ReadVolume read_picture_folder(const std::filesystem::path& folder, const CtReadSettings& settings,
                                             Monitor& monitor);

}  // namespace incise
