#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/geometry/volume.hpp>

#include <optional>

namespace incise {

/// The middle of the holder's platform, mm, in the robot's base frame.
inline const Vec3 kHolderMm(600.0, 0.0, 150.0);

/// How every laboratory holds a specimen (paper II-A), mm: length of the root in the clamp, length of the tip in the
/// suture, and distance by which the suture pulls the tip.
inline constexpr double kClampedMm = 14.0;
inline constexpr double kSuturedMm = 8.0;
inline constexpr double kDrawnMm = 20.0;

/// How a specimen was placed by hand, and how the camera above it is tilted.
struct Placement {
  double x_mm = 0.0, y_mm = 0.0;  ///< of the specimen from the holder's middle, base frame
  double turn_deg = 0.0;          ///< about the vertical
  double camera_tilt_deg = 0.0;   ///< from straight down
};

/// Returns the pose of the specimen's frame in the robot's base frame, 4 x 4, rigid, mm. The tip of the tongue (-y)
/// points towards the base.
[[nodiscard]] Mat4 T_robot_specimen(const Placement& placement);
/// Returns the pose of the camera in the robot's base frame, 4 x 4, rigid, mm. Camera axes: x to the right in the
/// picture, y down, z away from the camera.
[[nodiscard]] Mat4 T_robot_camera(const Placement& placement);

/// The readings of a specimen before it is cut.
struct Readings {
  CtVolume ct;      ///< before clamping; HU, LPS
  FrameShot frame;  ///< colour and depth after clamping and stretching, with the contour marked
  Points cloud_mm;  ///< the specimen's part of the depth picture, camera frame
  Mat4 T_robot_camera = Mat4::Identity();
  double stretch_force_n = 0.0;              ///< the suture's pull at 20 mm, as its gauge reads
  std::optional<double> stretch_force_noise_percent;  ///< of that gauge, by its data sheet; absent: unknown
  std::optional<GrayVolume> elasticity_kpa;  ///< elastography of the unclamped specimen, 20 % noise; 0: no tissue
};

}  // namespace incise
