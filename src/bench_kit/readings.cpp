#include <incise/bench_kit/readings.hpp>
#include <incise/core/units.hpp>

#include <Eigen/Geometry>

namespace incise {
namespace {

constexpr double kCameraHeightMm = 230.0;  // above the platform

}  // namespace

Mat4 T_robot_specimen(const Placement& placement) {
  Mat3 laid;
  laid << 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const Mat3 turn = Eigen::AngleAxisd(units::rad_from_deg(placement.turn_deg), Vec3::UnitZ()).toRotationMatrix();
  Mat4 T = Mat4::Identity();
  T.topLeftCorner<3, 3>() = turn * laid;
  T.topRightCorner<3, 1>() = kHolderMm + Vec3(placement.x_mm, placement.y_mm, 0.0);
  return T;
}

Mat4 T_robot_camera(const Placement& placement) {
  Mat3 down;
  down << 0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
  const double tilt = units::rad_from_deg(placement.camera_tilt_deg);
  Mat4 T = Mat4::Identity();
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix() * down;
  // The tilted camera keeps the holder in the middle of its picture.
  T.topRightCorner<3, 1>() = kHolderMm - kCameraHeightMm * T.block<3, 1>(0, 2);
  return T;
}

}  // namespace incise
