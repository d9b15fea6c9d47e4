#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/arm.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {
namespace {

constexpr double kWristSingularSine = 1e-10;  // below it, rounding determines joints 4 and 6

double wrapped(double angle) {
  const double turned = std::remainder(angle, 2.0 * units::kPi);
  return turned <= -units::kPi ? units::kPi : turned;
}

/// Target of the three parallel joints 2, 3 and 4, in the plane of the arm.
struct PlanarTarget {
  double x_mm = 0.0, y_mm = 0.0;  ///< first wrist joint, from the shoulder, perpendicular to joint 2's axis
  double angle_rad = 0.0;         ///< q2 + q3 + q4
};

/// Computes the target of joints 2, 3 and 4 from the other joints.
PlanarTarget planar_target(const ArmModel& arm, const Mat4& T, double q1, double q5, double q6) {
  const double s1 = std::sin(q1), c1 = std::cos(q1), s5 = std::sin(q5), c5 = std::cos(q5);
  const double s6 = std::sin(q6), c6 = std::cos(q6);
  const Mat3 R = T.topLeftCorner<3, 3>();
  // Frame 4: undo joints 6 and 5. Its x axis lies in the arm's plane, its z axis along the second wrist axis.
  const Vec3 x5 = c6 * R.col(0) - s6 * R.col(1), z5 = R.col(2);
  const Vec3 x4 = c5 * x5 - s5 * z5;
  const Vec3 z4 = -s6 * R.col(0) - c6 * R.col(1);
  const Vec3 origin4 = Vec3(T.topRightCorner<3, 1>()) - arm.d_mm[5] * z5 - arm.d_mm[4] * z4;
  const Vec3 in_plane(c1, s1, 0.0);
  return {in_plane.dot(origin4), origin4.z() - arm.d_mm[0], std::atan2(x4.z(), in_plane.dot(x4))};
}

/// Computes joints 2, 3 and 4 for one sign of the elbow; false if the target is too far or too near.
bool solve_planar(const ArmModel& arm, const PlanarTarget& target, bool is_elbow_negative, Joints& q) {
  const double a2 = arm.a_mm[1], a3 = arm.a_mm[2];
  const double r2 = target.x_mm * target.x_mm + target.y_mm * target.y_mm;
  const double c3 = (r2 - a2 * a2 - a3 * a3) / (2.0 * a2 * a3);
  constexpr double kRounding = 1e-12;  // by rounding, a stretched arm may be a few last bits too long
  if (std::abs(c3) > 1.0 + kRounding) return false;
  const double elbow = std::acos(std::clamp(c3, -1.0, 1.0));
  q[2] = is_elbow_negative ? -elbow : elbow;
  q[1] = std::atan2(target.y_mm, target.x_mm) - std::atan2(a3 * std::sin(q[2]), a2 + a3 * std::cos(q[2]));
  q[3] = target.angle_rad - q[1] - q[2];
  return true;
}

}  // namespace

InverseResult inverse_kinematics(const ArmModel& arm, const Mat4& T, double wrist3_rad) {
  INCISE_REQUIRE(T.allFinite(), "expected a finite pose");
  InverseResult result;
  const Mat3 R = T.topLeftCorner<3, 3>();
  // Intersection of the wrist's last two axes: joint 1 must turn the arm's plane to distance d4 from it.
  const Vec3 wrist = Vec3(T.topRightCorner<3, 1>()) - arm.d_mm[5] * R.col(2);
  const double away = std::hypot(wrist.x(), wrist.y());
  if (away < arm.d_mm[3]) {
    result.outcome = InverseOutcome::InsideShoulder;
    return result;
  }
  bool is_wrist_singular = false;
  for (int index = 0; index < 8; ++index) {
    const ArmBranch branch = arm_branch(index);
    Joints q;
    const double side = std::acos(std::min(1.0, arm.d_mm[3] / away));
    q[0] = std::atan2(wrist.y(), wrist.x()) + units::kPi / 2.0 + (branch.is_shoulder_right ? -side : side);
    // Components n, o, a of the flange's axes along the arm's sideways direction z1 = (s1, -c1, 0).
    const Vec3 z1(std::sin(q[0]), -std::cos(q[0]), 0.0);
    const double n = z1.dot(R.col(0)), o = z1.dot(R.col(1)), a = z1.dot(R.col(2));
    const double sine = std::hypot(n, o);  // accurate where the cosine is not
    q[4] = branch.is_wrist_flipped ? -std::atan2(sine, a) : std::atan2(sine, a);
    if (sine < kWristSingularSine) {
      is_wrist_singular = true;
      q[5] = wrist3_rad;
    } else {
      const double sign = branch.is_wrist_flipped ? -1.0 : 1.0;
      q[5] = std::atan2(-sign * o, sign * n);
    }
    if (!solve_planar(arm, planar_target(arm, T, q[0], q[4], q[5]), branch.is_elbow_negative, q)) continue;
    for (int i = 0; i < 6; ++i) q[i] = wrapped(q[i]);
    result.solutions.push_back({q, branch});
  }
  // Not all branches can be too near: plain and flipped wrist lie farther apart than the folded arm's gap is wide.
  if (result.solutions.empty())
    result.outcome = InverseOutcome::TooFar;
  else if (is_wrist_singular)
    result.outcome = InverseOutcome::WristSingular;
  return result;
}

}  // namespace incise
