#pragma once

#include <incise/robot/player.hpp>
#include <incise/robot/program.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// The tip's course that a program asks for, in the robot's base frame: its poses.
/// @throws InvalidArgument for a program with fewer than 2 poses or numbers that are not finite.
[[nodiscard]] std::vector<TipPose> asked_course(const RobotProgram& program);

/// The same as the arm's controller plays it: every 20 ms, and where a phase ends.
/// @param replay  completed, with at least 2 samples (InvalidArgument).  @param T_flange_tool  rigid, mm.
[[nodiscard]] std::vector<TipPose> asked_course(const Replay& replay, const Mat4& T_flange_tool,
                                                const ArmModel& arm = ur10e());

/// Where the arm really takes the tip: the course, off by the arm's hidden errors (offset, turn about the vertical
/// through the middle of the course, slow wandering), in the specimen's frame.
/// @param asked  frame robot.  @param T_specimen_robot  rigid: where the base frame really lies.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                              const Mat4& T_specimen_robot);

/// Why a course cannot be one for this specimen: while it cuts, the tip has to be in the tissue (0.5 to 12 mm below the
/// stretched skin at nine poses in ten), and the course has to go round the tumour's middle. nullopt: it can.
[[nodiscard]] std::optional<std::string> find_misfit(const BenchBody& body, const std::vector<TipPose>& course);

}  // namespace incise
