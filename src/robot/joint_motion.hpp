#pragma once

#include "robot/course.hpp"

#include <incise/robot/joint_motion.hpp>
#include <incise/robot/program.hpp>

#include <optional>

namespace incise::robot_detail {

/// A branch and a spin for a whole course.
struct BranchChoice {
  MotionOutcome outcome = MotionOutcome::Unreachable;
  std::size_t failed_pose = 0;  ///< if unreachable: the first pose that the farthest-reaching candidate cannot reach
  InverseOutcome why = InverseOutcome::Solved;  ///< if unreachable: why it cannot
  ArmBranch branch;
  double spin_deg = 0.0;
  Joints start_rad = Joints::Zero();  ///< joints at the first pose, whole turns included
};

/// Tries every branch and, unless `spin_deg` is given, evenly spaced spins. A candidate's merit is the least of
/// singular value, joint margin, table clearance and clearance between the arm's hulls, each divided by its good value
/// and at most 1. Among equal merits, the candidate with the least joint travel wins, counted from `setup.near_rad`.
/// @param program  with poses without spin
[[nodiscard]] BranchChoice choose_branch(const RobotProgram& program, const ArmSetup& setup,
                                         std::optional<double> spin_deg, const BranchPreferences& preferences = {});

/// Computes the joints along the whole course on the chosen branch.
[[nodiscard]] JointMotion follow_branch(const Course& course, const ToolFrame& frame, const BranchChoice& choice,
                                        const RobotProgram& program, const ArmSetup& setup);

}  // namespace incise::robot_detail
