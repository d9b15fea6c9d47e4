#pragma once

#include <filesystem>
#include <string>

namespace incise {

/// Checks the voxel size and units in an NRRD header. ITK assumes 1 mm along an axis whose vector is `none` or too long
/// to be squared, and ignores units. Source: the NRRD format (teem.sourceforge.net/nrrd/format.html).
/// @param header  its lines, in lower case
/// @throws DataError for no spacing, one outside kFinestVoxelMm to kCoarsestVoxelMm, or units other than millimetres.
void require_stated_nrrd_geometry(const std::filesystem::path& path, const std::string& header);

/// Whether an NRRD header, in lower case, names the anatomical space of its axes.
[[nodiscard]] bool names_nrrd_space(const std::string& header);

}  // namespace incise
