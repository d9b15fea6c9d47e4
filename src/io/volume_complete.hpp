#pragma once

#include <incise/io/volume_io.hpp>

#include <cstddef>
#include <filesystem>

namespace incise {

/// Checks that a NIfTI or MetaImage file holds all the voxels that its header announces. ITK accepts a truncated file
/// and leaves the missing voxels uninitialised; nor does it notice that the disk fills up while it writes. NRRD needs
/// no check, because its reader and writer report errors. Source: NIfTI-1 and -2 headers (nifti.nimh.nih.gov), MetaIO's
/// tag list.
/// @param voxel_bytes  size of the unpacked voxels
/// @throws DataError with the number of bytes found and expected.
void require_complete_voxels(const std::filesystem::path& path, VolumeFormat format, std::size_t voxel_bytes);

}  // namespace incise
