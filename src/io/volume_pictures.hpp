#pragma once

#include <incise/io/volume_io.hpp>

namespace incise {

/// Reads a folder of numbered gray PNG pictures as one CT. @throws as read_ct
[[nodiscard]] ReadVolume read_picture_folder(const std::filesystem::path& folder, const CtReadSettings& settings,
                                             Monitor& monitor);

}  // namespace incise
