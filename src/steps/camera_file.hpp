#pragma once

#include <incise/imaging/depth_camera.hpp>

#include <filesystem>

namespace incise::steps {

/// Intrinsics as JSON: width, height, fx, fy, cx, cy, depth_scale (metres for one count, as librealsense has it);
/// optional: distortion [k1, k2, p1, p2, k3], depth {the same without depth_scale} and T_color_depth where the depth
/// picture is not laid onto the colour picture. @throws DataError naming the key.
[[nodiscard]] DepthCamera read_depth_camera(const std::filesystem::path& file);

}  // namespace incise::steps
