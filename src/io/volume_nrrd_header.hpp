#pragma once

#include <filesystem>
#include <string>

namespace incise {

/// Checks what an NRRD header says of voxel size and units. ITK takes 1 mm along an axis whose vector is `none` or too
/// long to be squared, and passes over units. Source: the NRRD format (teem.sourceforge.net/nrrd/format.html).
/// @param header  its lines, in small letters.
/// @throws DataError for no spacing, one outside kFinestVoxelMm to kCoarsestVoxelMm, or units other than millimetres.
void require_stated_nrrd_geometry(const std::filesystem::path& path, const std::string& header);

/// Whether it names the space of its axes.
[[nodiscard]] bool names_nrrd_space(const std::string& header);

}  // namespace incise
