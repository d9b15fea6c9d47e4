#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Six joint angles (rad), speeds (rad/s) or accelerations (rad/s²), from the base to the wrist.
using Joints = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Radii of the round hulls that are held clear of each other, of the base and of the tissue, mm. They are our own
/// estimates, rounded up, from the published outline of the arm (foot 190 mm wide, flange 63 mm) and its tubes; compare
/// them with the maker's drawings, cables and covers before relying on them.
struct ArmHullRadii {
  double base = 95.0;
  double shoulder = 90.0;
  double upper_arm = 80.0;
  double elbow = 65.0;
  double forearm = 65.0;
  double wrist_1 = 55.0;
  double wrist_2 = 55.0;
  double wrist_3 = 50.0;
  /// The axis of wrist 3's hull ends this far behind the flange: its round end covers a flange of 86 mm and stands out
  /// by 25 mm.
  double flange_setback = 25.0;
};

/// A six-joint arm of Universal Robots' build: shoulder, upper arm and forearm in one plane, and a wrist of three
/// joints whose axes meet in pairs. Lengths are Denavit and Hartenberg's, mm: joint i is Rz(q) Tz(d) Tx(a) Rx(alpha)
/// with alpha = (90, 0, 0, 90, -90, 0) degrees.
struct ArmModel {
  std::string name;
  std::array<double, 6> d_mm{};
  std::array<double, 6> a_mm{};
  std::array<std::string, 6> joint_names;  ///< as in the maker's ROS description
  Joints min_rad, max_rad;                 ///< joint limits
  Joints max_speed_rad_s;
  /// Radii of the round hulls about the links that are held clear of the table: upper arm, forearm, wrist 1, 2 and 3.
  std::array<double, 5> link_radius_mm{};
  double shoulder_offset_mm = 0.0;  ///< the upper arm runs beside the plane of the joint frames by this much
  double elbow_offset_mm = 0.0;     ///< and the forearm by this much
  ArmHullRadii hull_radius_mm{};
};

/// Universal Robots UR10e. Lengths, joint limits and speeds as published [UrDh, UrDescription]; the elbow is limited
/// to half a turn either way, because the arm cannot go farther. The radii are ours, on the safe side of the drawings:
/// nothing of the arm sticks out of them but its joints' caps.
[[nodiscard]] const ArmModel& ur10e();

/// The frames of the base (0), of the links behind each joint (1..5) and of the flange (6) in the base frame, mm.
[[nodiscard]] std::array<Mat4, 7> joint_frames(const ArmModel& arm, const Joints& q);

/// T_base_flange, mm.
[[nodiscard]] Mat4 forward_kinematics(const ArmModel& arm, const Joints& q);

/// Which of an arm's eight ways to reach a pose.
///
///      shoulder left / right     elbow up / down          wrist plain / flipped
///          o--                       o                     joint 5 positive
///          |   seen from          o     o                  joint 5 negative
///        --o   above                 o  (about the line shoulder - wrist)
struct ArmBranch {
  bool is_shoulder_right = false;
  bool is_elbow_negative = false;
  bool is_wrist_flipped = false;
  [[nodiscard]] int index() const { return 4 * is_shoulder_right + 2 * is_elbow_negative + is_wrist_flipped; }
  friend bool operator==(const ArmBranch&, const ArmBranch&) = default;
};
[[nodiscard]] ArmBranch arm_branch(int index);                 ///< 0 to 7
[[nodiscard]] std::string to_string(const ArmBranch& branch);  ///< such as "shoulder left, elbow positive, wrist plain"

/// How the inverse ended.
enum class InverseOutcome {
  Solved,
  TooFar,          ///< the wrist would lie farther from the shoulder than the stretched arm reaches
  InsideShoulder,  ///< the wrist would lie inside the cylinder that the shoulder's offset sweeps
  WristSingular    ///< joints 4 and 6 turn about parallel axes: only their sum is known, joint 6 was chosen
};
inline constexpr std::array<std::string_view, 4> kInverseOutcomeNames{"solved", "too_far", "inside_shoulder",
                                                                      "wrist_singular"};
[[nodiscard]] constexpr Names names_of(InverseOutcome) {
  return kInverseOutcomeNames;
}

struct InverseSolution {
  Joints q_rad = Joints::Zero();  ///< each in (-pi, pi]
  ArmBranch branch;
};

struct [[nodiscard]] InverseResult {
  InverseOutcome outcome = InverseOutcome::Solved;
  std::vector<InverseSolution> solutions;  ///< up to eight; joint limits are not looked at
};

/// All joint angles that bring the flange to a pose, in closed form: at most eight.
/// With some of them out of reach, too near for the folded arm among them, `outcome` is Solved and those are missing.
/// In a wrist-singular pose joint 6 is taken to be `wrist3_rad`. Source: geometry of the arm; the steps are those of
/// [Hawkins2013].
/// @param T_base_flange  rigid, mm.
[[nodiscard]] InverseResult inverse_kinematics(const ArmModel& arm, const Mat4& T_base_flange, double wrist3_rad = 0.0);

/// Jacobian of a point fixed to the flange, in the base frame: rows 0-2 its velocity (mm/s), rows 3-5 angular velocity
/// (rad/s), per joint speed (rad/s).
[[nodiscard]] Mat6 jacobian(const ArmModel& arm, const Joints& q, const Vec3& point_in_flange_mm = Vec3::Zero());

/// Length that makes translations comparable with rotations in the singularity measure: about the length of upper arm
/// and of forearm.
inline constexpr double kArmLengthScaleMm = 600.0;

/// Distance from singularities: the smallest singular value of the flange's Jacobian with its translations over
/// kArmLengthScaleMm. 0 in a singular pose.
[[nodiscard]] double smallest_singular_value(const ArmModel& arm, const Joints& q);

/// Height of the lowest link hull above the plane z = `table_z_mm` of the base frame, mm; negative below it. The base
/// and the shoulder stand on the table and are not looked at.
[[nodiscard]] double table_clearance_mm(const ArmModel& arm, const Joints& q, double table_z_mm);

/// `q` with each joint turned by whole turns to lie as near as possible to `reference`.
[[nodiscard]] Joints nearest_turns(Joints q, const Joints& reference);

}  // namespace incise
