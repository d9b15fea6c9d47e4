#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>
#include <string_view>

namespace incise {

/// Range of a camera's scale: size in the camera's cloud divided by true size. A scale outside it is an error.
inline constexpr double kLeastCameraScale = 0.9;
inline constexpr double kMostCameraScale = 1.1;

/// Writes a `.ply` as write_ply does, for a cloud that a camera saw `camera_scale` times too large and that has been
/// brought to its true size. The number is stored in the comment `incise.camera_scale`, for later checks of scale.
/// @param camera_scale  in [kLeastCameraScale, kMostCameraScale]  @throws InvalidArgument otherwise; or as write_ply.
void write_ply_at_true_size(const std::filesystem::path& path, const TriMesh& cloud, double camera_scale,
                            std::string_view specimen_id = {});

/// Returns the scale in the comment `incise.camera_scale` of a `.ply`; 1 if the file has none or is of another format.
/// @throws DataError if the comment holds no number in range, or if the `.ply` cannot be read.
[[nodiscard]] double camera_scale_of(const std::filesystem::path& path);

}  // namespace incise
