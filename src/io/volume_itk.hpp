#pragma once

#include <incise/geometry/volume.hpp>
#include <incise/io/volume_io.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Type of the gray values in a file.
enum class Component { U8, I8, U16, I16, U32, I32, U64, I64, F32, F64 };

struct RawImage {
  VolumeGrid grid;  ///< LPS, mm; a picture has size[2] = 1
  Component component = Component::I16;
  std::string bytes;                 ///< grid.voxel_count() components in machine byte order, i fastest
  std::vector<std::string> notices;  ///< remarks on the file, for the user
};
inline void describe(Visitor& v, RawImage& image) {
  v("grid", image.grid, "Grid of the voxels.");
  auto component = static_cast<int>(image.component);
  v("component", component, "Type of the values.", {0.0, static_cast<double>(Component::F64)});
  image.component = static_cast<Component>(component);
  v("notices", image.notices, "Remarks on the file.");
  v("bytes", image.bytes, "The values.");  // last: a text that is appended to such a large one would double its memory
}

/// Returns the volume format of a file name, in upper or lower case; nothing for other names.
[[nodiscard]] std::optional<VolumeFormat> format_of_name(const std::filesystem::path& path);

/// Reads one gray image in the given format. @throws DataError
[[nodiscard]] RawImage read_itk_image(const std::filesystem::path& path, VolumeFormat format);

/// Returns the format of a file to be written. @throws DataError if its extension is not one of a volume file.
[[nodiscard]] VolumeFormat format_to_write(const std::filesystem::path& path);

/// Writes one gray volume, compressed if the format allows it, all or nothing. @throws DataError
void write_itk_image(const std::filesystem::path& path, const VolumeGrid& grid, Component component,
                     const void* voxels);

/// Checks a grid before writing.
/// @throws InvalidArgument unless it is finite, positive and orthonormal and has `voxels` voxels, one or more.
void require_writable_grid(const VolumeGrid& grid, std::size_t voxels);

}  // namespace incise
