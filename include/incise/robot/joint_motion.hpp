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

/// The arm, its tool and its table.
struct ArmSetup {
  ArmModel arm = ur10e();
  /// The tool's frame in the flange's, mm: origin at the tip, z along the tool out of its tip.
  Mat4 T_flange_tool = (Mat4() << 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 150, 0, 0, 0, 1).finished();
  /// Likely joints of the arm before the program. Of the whole turns that give the same pose, the nearest to these are
  /// taken.
  Joints near_rad = (Joints() << 0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0).finished();
  double table_z_mm = 0.0;  ///< height of the table's plane in the base frame
  double period_s = 0.008;  ///< between two samples of a motion; 0.001 to 0.1
};
/// Returns every violation; empty if valid.
[[nodiscard]] std::vector<Problem> validate(const ArmSetup& setup);

/// Preferences for the choice of branch and spin. Beyond the good values, less joint travel counts more. The checks
/// before export have separate limits (CheckSettings).
struct BranchPreferences {
  double good_singular_value = 0.10;    ///< good distance from singularities (smallest_singular_value)
  double good_joint_margin_deg = 20.0;  ///< good distance from the joint limits
  double good_clearance_mm = 50.0;      ///< good distance of the links from the table
  double good_arm_clearance_mm = 12.0;  ///< good distance between the arm's hulls, the base's included
  int spin_steps = 36;                  ///< number of evenly spaced spins to try; the tool is round
  int places = 24;                      ///< merit is evaluated at about this many poses of the course
};

enum class MotionOutcome {
  Found,
  Unreachable,  ///< no branch and no spin reaches every place of the course
  Jump          ///< on the chosen branch the joints would have to jump (a singularity is crossed)
};
inline constexpr std::array<std::string_view, 3> kMotionOutcomeNames{"found", "unreachable", "jump"};
[[nodiscard]] constexpr Names names_of(MotionOutcome) {
  return kMotionOutcomeNames;
}

/// The arm at one time.
struct JointSample {
  double time_s = 0.0;  ///< from the start of the program
  Joints q_rad = Joints::Zero();
  Joints speed_rad_s = Joints::Zero();
  Joints acceleration_rad_s2 = Joints::Zero();
  std::size_t pose = 0;  ///< index of the program's pose at or before this time
};

/// The arm's motion along the whole course of a program, sampled every `period_s`. The last sample lies at the end of
/// the course, or less than one period after it.
struct [[nodiscard]] JointMotion {
  MotionOutcome outcome = MotionOutcome::Unreachable;
  std::optional<std::size_t> failed_pose;  ///< index of the first pose that cannot be reached
  std::string reason;                      ///< why it cannot be reached
  ArmBranch branch;
  double spin_deg = 0.0;
  double period_s = 0.0;
  double min_singular_value = 0.0;
  double min_joint_margin_deg = 0.0;
  double min_table_clearance_mm = 0.0;
  double travel_deg = 0.0;           ///< total angle that all joints turn through
  std::vector<JointSample> samples;  ///< empty unless the outcome is Found
};

}  // namespace incise
