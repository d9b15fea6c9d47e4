#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Six joint angles (rad), speeds (rad/s) or accelerations (rad/s²), ordered from the base to the wrist.
using Joints = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Radii of the arm's capsules, mm, which must keep clear of each other, of the base and of the tissue. They are our
/// own estimates, rounded up from the published outline of the arm (foot 190 mm wide, flange 63 mm) and its tubes.
/// Compare them with the maker's drawings, with cables and covers, before you rely on them.
struct ArmHullRadii {
  double base = 95.0;
  double shoulder = 90.0;
  double upper_arm = 80.0;
  double elbow = 65.0;
  double forearm = 65.0;
  double wrist_1 = 55.0;
  double wrist_2 = 55.0;
  double wrist_3 = 50.0;
  /// The axis of wrist 3's hull ends this far behind the flange, mm. The round end then covers a flange of 86 mm and
  /// extends 25 mm beyond it.
  double flange_setback = 25.0;
};

/// A six-joint arm of the Universal Robots type: shoulder, upper arm and forearm lie in one plane, and the axes of the
/// three wrist joints meet in pairs. Lengths follow Denavit and Hartenberg, mm: joint i is Rz(q) Tz(d) Tx(a) Rx(alpha)
/// with alpha = (90, 0, 0, 90, -90, 0) degrees.
struct ArmModel {
  std::string name;
  std::array<double, 6> d_mm{};
  std::array<double, 6> a_mm{};
  std::array<std::string, 6> joint_names;  ///< as in the maker's ROS description
  Joints min_rad, max_rad;                 ///< joint limits
  Joints max_speed_rad_s;
  /// Radii of the links for the clearance from the table: upper arm, forearm, wrist 1, 2 and 3.
  std::array<double, 5> link_radius_mm{};
  double shoulder_offset_mm = 0.0;  ///< distance of the upper arm from the plane of the joint frames
  double elbow_offset_mm = 0.0;     ///< distance of the forearm from that plane
  ArmHullRadii hull_radius_mm{};
};

/// Returns the model of the Universal Robots UR10e. Lengths, joint limits and speeds are as published [UrDh,
/// UrDescription]; the elbow is limited to half a turn either way, because the arm cannot turn farther. The radii are
/// our own and larger than the drawings show: only the joints' caps project beyond them.
[[nodiscard]] const ArmModel& ur10e();

/// Returns the frames of the base (0), of the links behind each joint (1..5) and of the flange (6), 4 x 4 each, in the
/// base frame, mm.
[[nodiscard]] std::array<Mat4, 7> joint_frames(const ArmModel& arm, const Joints& q);

/// Returns T_base_flange, 4 x 4, mm.
[[nodiscard]] Mat4 forward_kinematics(const ArmModel& arm, const Joints& q);

/// One of the eight ways in which an arm can reach a pose.
///
///      shoulder left / right     elbow positive/negative  wrist plain / flipped
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
[[nodiscard]] ArmBranch arm_branch(int index);                 ///< inverse of ArmBranch::index; @pre 0 to 7
[[nodiscard]] std::string to_string(const ArmBranch& branch);  ///< such as "shoulder left, elbow positive, wrist plain"

/// Outcome of inverse_kinematics.
enum class InverseOutcome {
  Solved,
  TooFar,          ///< the wrist would lie farther from the shoulder than the stretched arm reaches
  InsideShoulder,  ///< the wrist would lie inside the cylinder that the shoulder's offset sweeps
  WristSingular    ///< joints 4 and 6 turn about parallel axes: only their sum is determined; joint 6 was chosen
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
  std::vector<InverseSolution> solutions;  ///< up to eight; joint limits are not checked
};

/// Computes all joint angles that bring the flange to a pose, in closed form: at most eight solutions, one per branch.
/// Branches that cannot reach the pose, for instance because it is too near for the folded arm, are omitted; if at
/// least one branch reaches it, `outcome` is Solved or WristSingular.
/// @param T_base_flange  rigid, 4 x 4, mm.
/// @param wrist3_rad     joint 6 in a wrist-singular pose.
/// @throws InvalidArgument if the pose is not finite.
/// Source: geometry of the arm, with the steps of [Hawkins2013].
[[nodiscard]] InverseResult inverse_kinematics(const ArmModel& arm, const Mat4& T_base_flange, double wrist3_rad = 0.0);

/// Returns the Jacobian of a point fixed to the flange, in the base frame, per joint speed (rad/s): rows 0-2 give the
/// velocity of the point (mm/s), rows 3-5 the angular velocity (rad/s).
[[nodiscard]] Mat6 jacobian(const ArmModel& arm, const Joints& q, const Vec3& point_in_flange_mm = Vec3::Zero());

/// Length that makes translations comparable with rotations in smallest_singular_value: about the length of the upper
/// arm and of the forearm.
inline constexpr double kArmLengthScaleMm = 600.0;

/// Returns the distance from singularities: the smallest singular value of the flange's Jacobian, with its translations
/// divided by kArmLengthScaleMm. Without unit; 0 in a singular pose.
[[nodiscard]] double smallest_singular_value(const ArmModel& arm, const Joints& q);

/// Returns the height of the lowest link (with ArmModel::link_radius_mm) above the plane z = `table_z_mm` of the base
/// frame, mm; negative below it. The base and the shoulder stand on the table and are not checked.
[[nodiscard]] double table_clearance_mm(const ArmModel& arm, const Joints& q, double table_z_mm);

/// Returns `q` with whole turns added to each joint, so that it lies as near as possible to `reference`; rad.
[[nodiscard]] Joints nearest_turns(Joints q, const Joints& reference);

}  // namespace incise
