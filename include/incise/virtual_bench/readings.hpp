#pragma once

#include <incise/core/monitor.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/virtual_bench/body.hpp>
#include <incise/virtual_bench/pictures.hpp>

#include <optional>

namespace incise {

/// The middle of the holder's platform, mm, in the robot's base frame.
inline const Vec3 kHolderMm(600.0, 0.0, 150.0);

/// Where the specimen's frame really lies in the robot's base frame. Hidden.
[[nodiscard]] Mat4 T_robot_specimen(const Specimen& specimen);
/// Where the camera stands; x to the right of the picture, y down, z away from it. Known from its calibration; what is
/// wrong with it counts as the arm's error.
[[nodiscard]] Mat4 T_robot_camera(const Specimen& specimen);

/// What a laboratory has of a specimen before it cuts.
struct Readings {
  CtVolume ct;      ///< before clamping; HU, LPS
  FrameShot frame;  ///< colour and depth after clamping and stretching, with the contour marked
  Points cloud_mm;  ///< the specimen's part of the depth picture, camera frame
  Mat4 T_robot_camera = Mat4::Identity();
  double stretch_force_n = 0.0;              ///< the suture's pull at its 20 mm, load cell with 5 % noise
  std::optional<GrayVolume> elasticity_kpa;  ///< elastography of the unclamped specimen, 20 % noise; 0: no tissue
};

/// Takes all readings of a specimen in its holder. The same body gives the same bits.
/// @param has_elasticity  also the elasticity map.  @throws Cancelled.
[[nodiscard]] Readings take_readings(const BenchBody& body, bool has_elasticity, Monitor& monitor);

}  // namespace incise
