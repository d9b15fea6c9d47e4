#pragma once

#include <incise/imaging/depth_camera.hpp>

#include <filesystem>

namespace incise::steps {

/// Reads intrinsics from JSON: width, height, fx, fy, cx, cy, depth_scale (metres per count, as in librealsense);
/// optional: distortion [k1, k2, p1, p2, k3], and, if the depth picture is not aligned with the colour picture, depth
/// {the same without depth_scale} and T_color_depth. @throws DataError naming the key.
[[nodiscard]] DepthCamera read_depth_camera(const std::filesystem::path& file);

}  // namespace incise::steps
