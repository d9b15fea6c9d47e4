#pragma once

#include <incise/geometry/volume.hpp>
#include <incise/io/volume_io.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Gray values as a file holds them, before they are given a meaning.
enum class Component { U8, I8, U16, I16, U32, I32, U64, I64, F32, F64 };

struct RawImage {
  VolumeGrid grid;  ///< LPS, mm; a picture has size[2] = 1
  Component component = Component::I16;
  std::vector<char> bytes;           ///< grid.voxel_count() components in machine byte order, i fastest
  std::vector<std::string> notices;  ///< what a reader should tell about the file
};

/// The volume format that a file name stands for; nothing for other names. Upper case counts too.
[[nodiscard]] std::optional<VolumeFormat> format_of_name(const std::filesystem::path& path);

/// Reads one gray image in the given format. @throws DataError
[[nodiscard]] RawImage read_itk_image(const std::filesystem::path& path, VolumeFormat format);

/// The format of a file to be written. @throws DataError for an extension that is none of them.
[[nodiscard]] VolumeFormat format_to_write(const std::filesystem::path& path);

/// Writes one gray volume, compressed where the format can be, all or nothing. @throws DataError
void write_itk_image(const std::filesystem::path& path, const VolumeGrid& grid, Component component,
                     const void* voxels);

/// @throws InvalidArgument unless the grid is finite, positive and orthonormal and has `voxels` voxels, one or more.
void require_writable_grid(const VolumeGrid& grid, std::size_t voxels);

}  // namespace incise
