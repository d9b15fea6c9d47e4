#pragma once

#include <incise/io/volume_io.hpp>

#include <cstddef>
#include <filesystem>

namespace incise {

/// Checks that a NIfTI or MetaImage file holds all the voxels that its header announces. ITK takes a file that is cut
/// short for whole and leaves the rest as it is in memory; it does not notice a disk that fills up while it writes,
/// either. NRRD needs no check: its reader and writer tell. Source: NIfTI-1 and -2 headers (nifti.nimh.nih.gov),
/// MetaIO's tag list.
/// @param voxel_bytes  size of the voxels once unpacked.
/// @throws DataError naming how many bytes there are and how many there should be.
void require_complete_voxels(const std::filesystem::path& path, VolumeFormat format, std::size_t voxel_bytes);

}  // namespace incise
