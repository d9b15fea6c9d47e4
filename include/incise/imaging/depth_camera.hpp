#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/picture.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace incise {

/// A pinhole camera with lens distortion (Brown and Conrady, in the convention of OpenCV and librealsense). Its frame:
/// x to the right, y down, z away from the camera. The centre of pixel (u, v) is at (u, v).
struct CameraIntrinsics {
  int width = 0, height = 0;
  double fx = 0.0, fy = 0.0;           ///< focal lengths, pixels, > 0
  double cx = 0.0, cy = 0.0;           ///< principal point, pixels
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3
};

/// Returns the direction of the ray through a pixel, scaled to z = 1, in the camera's frame, without distortion.
/// @throws InvalidArgument if the distortion cannot be inverted there.
[[nodiscard]] Vec3 ray_through(const CameraIntrinsics& camera, const Vec2& pixel);
/// Returns the pixel, distortion included, that shows point `p` (mm, camera frame). @throws InvalidArgument unless
/// p.z() > 0.
[[nodiscard]] Vec2 pixel_of(const CameraIntrinsics& camera, const Vec3& p);

/// A colour camera and a depth camera, rigidly mounted to each other.
struct DepthCamera {
  CameraIntrinsics color;
  CameraIntrinsics depth;
  double depth_unit_mm = 0.1;             ///< mm per count of the depth picture, > 0
  Mat4 T_color_depth = Mat4::Identity();  ///< p_color = T_color_depth * p_depth; rigid, mm
};

/// One point for each pixel of a colour picture, mm, in the colour camera's frame.
struct OrganizedCloud {
  int width = 0, height = 0;
  Points points;                          ///< width * height, by rows; (0, 0, 0) where nothing was measured
  std::vector<std::uint8_t> is_measured;  ///< width * height; 1 where measured
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
  }
  [[nodiscard]] std::size_t measured() const;  ///< number of measured points
};

/// Maps a depth picture onto the colour picture: each count above 0 becomes a point at the colour pixel that sees it.
/// If several points fall on one pixel, the nearest is kept.
/// @throws InvalidArgument if sizes differ from the intrinsics or values are out of range.
[[nodiscard]] OrganizedCloud cloud_seen_in_color(const DepthPicture& depth, const DepthCamera& camera);

/// Checks that a cloud is in the frame of its own camera: x to the right, y down, z away from the camera.
/// @throws DataError if a point lies behind the camera, or if columns and rows are mirrored.
void require_camera_frame(const OrganizedCloud& cloud, const std::filesystem::path& name);

struct LiftSettings {
  int window_px = 4;         ///< half width of the window in which a plane is fitted to the positions, >= 1
  double max_hole_mm = 2.0;  ///< longest hole in the depth that is interpolated, >= 0
};
/// A line of a picture, lifted into space.
struct LiftedLine {
  Contour contour;                 ///< mm, in the cloud's frame, one point per pixel, in order
  std::size_t bridged_points = 0;  ///< interpolated points
  double max_hole_mm = 0.0;        ///< longest interpolated hole
};
/// Returns the position (mm, cloud frame) at a sub-pixel place: the value there of a plane in (u, v), fitted to the
/// measured points in the window whose depth differs from the median by at most 3 robust deviations + 0.2 mm. Returns
/// nullopt if less than 40 % of the window is measured (30 % without outliers), or only one side of it.
/// @throws InvalidArgument if window_px < 1.
[[nodiscard]] std::optional<Vec3> position_at(const OrganizedCloud& cloud, const Vec2& pixel, int window_px);
/// Lifts a line of at least 2 pixels into space; interpolates linearly across holes in the depth.
/// @param name  file name for messages.
/// @throws InvalidArgument for fewer than 2 pixels, or settings out of range.
/// @throws DataError, with size and pixel, if a hole is larger than allowed or lies at an end of an open line.
[[nodiscard]] LiftedLine lift_to_space(const std::vector<Vec2>& points_px, bool is_closed, const OrganizedCloud& cloud,
                                       const LiftSettings& settings, const std::filesystem::path& name);

}  // namespace incise
