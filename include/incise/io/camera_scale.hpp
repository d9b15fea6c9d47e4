#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>
#include <string_view>

namespace incise {

/// Between these a camera's scale is taken out of its cloud; one beyond them is a mistake.
inline constexpr double kLeastCameraScale = 0.9;
inline constexpr double kMostCameraScale = 1.1;

/// As write_ply, for a cloud that a camera saw `camera_scale` times too large and that was brought to its true size
/// since: a comment `incise.camera_scale` keeps the number, so that whoever judges the scale of what follows knows of
/// it.
void write_ply_at_true_size(const std::filesystem::path& path, const TriMesh& cloud, double camera_scale,
                            std::string_view specimen_id = {});

/// That number; 1 for any other file. @throws DataError for a comment that holds no scale between the limits.
[[nodiscard]] double camera_scale_of(const std::filesystem::path& path);

}  // namespace incise
