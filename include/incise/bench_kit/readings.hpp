#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/geometry/volume.hpp>

#include <optional>

namespace incise {

/// The middle of the holder's platform, mm, in the robot's base frame.
inline const Vec3 kHolderMm(600.0, 0.0, 150.0);

/// How every laboratory holds a specimen (paper II-A), mm: what the clamp takes of the root, what the suture takes of
/// the tip, and how far the suture is drawn.
inline constexpr double kClampedMm = 14.0;
inline constexpr double kSuturedMm = 8.0;
inline constexpr double kDrawnMm = 20.0;

/// How a specimen was set down by hand, and how the camera over it is held.
struct Placement {
  double x_mm = 0.0, y_mm = 0.0;  ///< of the specimen from the holder's middle, base frame
  double turn_deg = 0.0;          ///< about the vertical
  double camera_tilt_deg = 0.0;   ///< from straight down
};

/// Where the specimen's frame lies in the robot's base frame: the tip of the tongue (-y) points back to the base.
[[nodiscard]] Mat4 T_robot_specimen(const Placement& placement);
/// Where the camera stands; x to the right of the picture, y down, z away from it.
[[nodiscard]] Mat4 T_robot_camera(const Placement& placement);

/// What a laboratory has of a specimen before it cuts.
struct Readings {
  CtVolume ct;      ///< before clamping; HU, LPS
  FrameShot frame;  ///< colour and depth after clamping and stretching, with the contour marked
  Points cloud_mm;  ///< the specimen's part of the depth picture, camera frame
  Mat4 T_robot_camera = Mat4::Identity();
  double stretch_force_n = 0.0;              ///< the suture's pull at its 20 mm, as its gauge says
  std::optional<double> stretch_force_noise_percent;  ///< of that gauge, as its maker says; absent: nothing is known
  std::optional<GrayVolume> elasticity_kpa;  ///< elastography of the unclamped specimen, 20 % noise; 0: no tissue
};

}  // namespace incise
