#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/robot/arm.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// What holds the tool, and how.
struct ArmSetup {
  ArmModel arm = ur10e();
  /// The tool's frame in the flange's, mm: origin at the tip, z along the tool out of its tip.
  Mat4 T_flange_tool = (Mat4() << 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 150, 0, 0, 0, 1).finished();
  /// Joints that the arm is likely to stand at: of the turns that mean the same pose the nearest to these are taken.
  Joints near_rad = (Joints() << 0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0).finished();
  double table_z_mm = 0.0;  ///< height of the table's plane in the base frame
  double period_s = 0.008;  ///< between two samples of a motion
};
/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const ArmSetup& setup);

/// What a motion is held to when its branch is chosen; the export's checks have limits of their own.
struct BranchPreferences {
  double good_singular_value = 0.10;    ///< more distance from singularities is not worth any travel
  double good_joint_margin_deg = 20.0;  ///< likewise from joint limits
  double good_clearance_mm = 50.0;      ///< likewise from the table
  double good_arm_clearance_mm = 12.0;  ///< likewise between its own hulls and from the base
  int spin_steps = 36;                  ///< turns of the tool about its own axis to look at; it is round
  int places = 24;                      ///< of the course where a candidate's merit is looked at
};

enum class MotionOutcome {
  Found,
  Unreachable,  ///< no branch and no spin reaches every place of the course
  Jump          ///< the chosen branch needs a jump of the joints (a singularity is crossed)
};
inline constexpr std::array<std::string_view, 3> kMotionOutcomeNames{"found", "unreachable", "jump"};
[[nodiscard]] constexpr Names names_of(MotionOutcome) {
  return kMotionOutcomeNames;
}

/// The arm at one time.
struct JointSample {
  double time_s = 0.0;
  Joints q_rad = Joints::Zero();
  Joints speed_rad_s = Joints::Zero();
  Joints acceleration_rad_s2 = Joints::Zero();
  std::size_t pose = 0;  ///< of the program, at or before this time
};

/// The arm's motion along the whole course of a program, at even times; the last step may be shorter.
struct [[nodiscard]] JointMotion {
  MotionOutcome outcome = MotionOutcome::Unreachable;
  std::optional<std::size_t> failed_pose;  ///< of the program: the first that cannot be reached
  std::string reason;                      ///< why, in words
  ArmBranch branch;
  double spin_deg = 0.0;
  double period_s = 0.0;
  double min_singular_value = 0.0;
  double min_joint_margin_deg = 0.0;
  double min_table_clearance_mm = 0.0;
  double travel_deg = 0.0;  ///< sum of the ways of all joints
  std::vector<JointSample> samples;
};

}  // namespace incise
