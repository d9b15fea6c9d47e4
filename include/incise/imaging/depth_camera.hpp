#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/picture.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace incise {

/// A pinhole with lens distortion (Brown and Conrady, as OpenCV and librealsense write it): x to the right, y down, z
/// away from the camera. Pixel (u, v) has its centre at (u, v).
struct CameraIntrinsics {
  int width = 0, height = 0;
  double fx = 0.0, fy = 0.0;           ///< focal lengths, pixels, > 0
  double cx = 0.0, cy = 0.0;           ///< principal point, pixels
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3
};

/// The direction through a pixel, z = 1; distortion is undone. @throws InvalidArgument where that cannot be done.
[[nodiscard]] Vec3 ray_through(const CameraIntrinsics& camera, const Vec2& pixel);
/// The pixel that shows a point in front of the camera. @pre p.z() > 0
[[nodiscard]] Vec2 pixel_of(const CameraIntrinsics& camera, const Vec3& p);

/// A colour camera and a depth camera, fixed to each other.
struct DepthCamera {
  CameraIntrinsics color;
  CameraIntrinsics depth;
  double depth_unit_mm = 0.1;             ///< mm for one count
  Mat4 T_color_depth = Mat4::Identity();  ///< p_color = T_color_depth * p_depth; rigid, mm
};

/// One point for each pixel of a colour picture, mm, in the colour camera's frame.
struct OrganizedCloud {
  int width = 0, height = 0;
  Points points;                          ///< width * height; (0, 0, 0) where nothing was measured
  std::vector<std::uint8_t> is_measured;  ///< width * height
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
  }
  [[nodiscard]] std::size_t measured() const;
};

/// Lays a depth picture onto the colour picture: every count becomes a point and lands on the pixel that sees it, the
/// nearest point where several do. @throws InvalidArgument for sizes that differ from the intrinsics or values out of
/// range.
[[nodiscard]] OrganizedCloud cloud_seen_in_color(const DepthPicture& depth, const DepthCamera& camera);

/// Refuses a cloud that is not in the frame of the camera whose picture it fills: x to the right, y down, z away from
/// it.
/// @throws DataError for a point behind the camera, or columns and rows that run as in a mirror.
void require_camera_frame(const OrganizedCloud& cloud, const std::filesystem::path& name);

struct LiftSettings {
  int window_px = 4;         ///< half the window over which positions are averaged by a fitted plane, >= 1
  double max_hole_mm = 2.0;  ///< longest stretch without depth that is interpolated, >= 0
};
/// A line of a picture in space.
struct LiftedLine {
  Contour contour;  ///< mm, in the cloud's frame; order of the pixels
  std::size_t bridged_points = 0;
  double max_hole_mm = 0.0;  ///< longest stretch interpolated
};
/// Position at a place between pixels: a plane in (u, v), fitted to the measured points around whose depth agrees with
/// their median (within 3 robust deviations and 0.2 mm); nullopt where fewer than 40 % of the window, or only one side
/// of it, are measured.
[[nodiscard]] std::optional<Vec3> position_at(const OrganizedCloud& cloud, const Vec2& pixel, int window_px);
/// Lifts a line. @throws DataError naming the size of a hole in the depth that is larger than allowed, and its pixel.
[[nodiscard]] LiftedLine lift_to_space(const std::vector<Vec2>& points_px, bool is_closed, const OrganizedCloud& cloud,
                                       const LiftSettings& settings, const std::filesystem::path& name);

}  // namespace incise
