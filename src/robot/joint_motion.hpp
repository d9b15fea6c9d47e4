#pragma once

#include "robot/course.hpp"

#include <incise/robot/joint_motion.hpp>
#include <incise/robot/program.hpp>

#include <optional>

namespace incise::robot_detail {

/// A branch and a spin for a whole course, and what speaks for them.
struct BranchChoice {
  MotionOutcome outcome = MotionOutcome::Unreachable;
  std::size_t failed_pose = 0;  ///< unreachable: the first pose that the farthest-reaching candidate cannot reach
  InverseOutcome why = InverseOutcome::Solved;
  ArmBranch branch;
  double spin_deg = 0.0;
  Joints start_rad = Joints::Zero();  ///< with the right number of whole turns
};

/// Looks at every branch and, unless `spin_deg` is given, at turns of the tool about its own axis. A candidate's merit
/// is the least of singular value, joint margin and table clearance, each over the value that is good enough and at
/// most 1; of equal merit the candidate with the least joint travel wins, the way from `setup.near_rad` to its start
/// included.
/// @param program  its poses without spin
[[nodiscard]] BranchChoice choose_branch(const RobotProgram& program, const ArmSetup& setup,
                                         std::optional<double> spin_deg, const BranchPreferences& preferences = {});

/// The joints along the whole course on the chosen branch.
[[nodiscard]] JointMotion follow_branch(const Course& course, const ToolFrame& frame, const BranchChoice& choice,
                                        const RobotProgram& program, const ArmSetup& setup);

}  // namespace incise::robot_detail
