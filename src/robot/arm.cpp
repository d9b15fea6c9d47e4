#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/arm.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::array<double, 6> kAlpha{units::kPi / 2, 0, 0, units::kPi / 2, -units::kPi / 2, 0};

Mat4 link_transform(const ArmModel& arm, std::size_t i, double q) {
  const double c = std::cos(q), s = std::sin(q);
  // Cosines of the twists are 0 or 1 exactly; std::cos would leave 6e-17.
  const double ca = kAlpha[i] == 0.0 ? 1.0 : 0.0, sa = kAlpha[i] == 0.0 ? 0.0 : (kAlpha[i] > 0.0 ? 1.0 : -1.0);
  Mat4 t;
  t << c, -s * ca, s * sa, arm.a_mm[i] * c,  //
      s, c * ca, -c * sa, arm.a_mm[i] * s,   //
      0, sa, ca, arm.d_mm[i],                //
      0, 0, 0, 1;
  return t;
}

Joints degrees(std::array<double, 6> values) {
  Joints result;
  for (int i = 0; i < 6; ++i) result[i] = units::rad_from_deg(values[static_cast<std::size_t>(i)]);
  return result;
}

ArmModel make_ur10e() {
  ArmModel arm;
  arm.name = "ur10e";
  arm.d_mm = {180.7, 0.0, 0.0, 174.15, 119.85, 116.55};
  arm.a_mm = {0.0, -612.7, -571.55, 0.0, 0.0, 0.0};
  arm.joint_names = {"shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
                     "wrist_1_joint",      "wrist_2_joint",       "wrist_3_joint"};
  arm.max_rad = degrees({360, 360, 180, 360, 360, 360});
  arm.min_rad = -arm.max_rad;
  arm.max_speed_rad_s = degrees({120, 120, 180, 180, 180, 180});
  arm.link_radius_mm = {95.0, 75.0, 65.0, 65.0, 60.0};
  arm.shoulder_offset_mm = 176.2;
  arm.elbow_offset_mm = 39.3;
  return arm;
}

}  // namespace

const ArmModel& ur10e() {
  static const ArmModel arm = make_ur10e();
  return arm;
}

std::array<Mat4, 7> joint_frames(const ArmModel& arm, const Joints& q) {
  std::array<Mat4, 7> frames;
  frames[0] = Mat4::Identity();
  for (std::size_t i = 0; i < 6; ++i) frames[i + 1] = frames[i] * link_transform(arm, i, q[static_cast<int>(i)]);
  return frames;
}

Mat4 forward_kinematics(const ArmModel& arm, const Joints& q) {
  return joint_frames(arm, q)[6];
}

Mat6 jacobian(const ArmModel& arm, const Joints& q, const Vec3& point_in_flange_mm) {
  const auto frames = joint_frames(arm, q);
  const Vec3 point = frames[6].topLeftCorner<3, 3>() * point_in_flange_mm + Vec3(frames[6].topRightCorner<3, 1>());
  Mat6 result;
  for (int i = 0; i < 6; ++i) {
    const Mat4& frame = frames[static_cast<std::size_t>(i)];
    const Vec3 axis = frame.block<3, 1>(0, 2), origin = frame.block<3, 1>(0, 3);
    result.block<3, 1>(0, i) = axis.cross(point - origin);
    result.block<3, 1>(3, i) = axis;
  }
  return result;
}

double smallest_singular_value(const ArmModel& arm, const Joints& q) {
  Mat6 scaled = jacobian(arm, q);
  scaled.topRows<3>() /= kArmLengthScaleMm;
  // From the eigenvalues of J J^T: accurate to 1e-8 of the largest, which is enough here, and ten times as fast.
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(scaled * scaled.transpose(), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

double table_clearance_mm(const ArmModel& arm, const Joints& q, double table_z_mm) {
  const auto frames = joint_frames(arm, q);
  const auto origin = [&](std::size_t i) { return Vec3(frames[i].topRightCorner<3, 1>()); };
  const Vec3 side = frames[1].block<3, 1>(0, 2);  // axis of the shoulder, elbow and first wrist joint
  const Vec3 shoulder = arm.shoulder_offset_mm * side, elbow = arm.elbow_offset_mm * side;
  // The links are round rods from joint to joint. The shoulder end of the upper arm has a fixed height and is ignored.
  const std::array<std::array<Vec3, 2>, 5> rods{{{origin(1) + shoulder, origin(2) + shoulder},
                                                 {origin(2) + elbow, origin(3) + elbow},
                                                 {origin(3) + elbow, origin(4)},
                                                 {origin(4), origin(5)},
                                                 {origin(5), origin(6)}}};
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rods.size(); ++i) {
    const double z = i == 0 ? rods[i][1].z() : std::min(rods[i][0].z(), rods[i][1].z());
    lowest = std::min(lowest, z - arm.link_radius_mm[i] - table_z_mm);
  }
  return lowest;
}

Joints nearest_turns(Joints q, const Joints& reference) {
  for (int i = 0; i < 6; ++i) q[i] += 2.0 * units::kPi * std::round((reference[i] - q[i]) / (2.0 * units::kPi));
  return q;
}

ArmBranch arm_branch(int index) {
  INCISE_REQUIRE(index >= 0 && index < 8, fmt::format("expected a branch from 0 to 7, found {}", index));
  return {(index & 4) != 0, (index & 2) != 0, (index & 1) != 0};
}

std::string to_string(const ArmBranch& branch) {
  return fmt::format("shoulder {}, elbow {}, wrist {}", branch.is_shoulder_right ? "right" : "left",
                     branch.is_elbow_negative ? "negative" : "positive", branch.is_wrist_flipped ? "flipped" : "plain");
}

}  // namespace incise
