#pragma once

#include <incise/core/verdict.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program.hpp>
#include <incise/robot/program_text.hpp>
#include <incise/workflow/study.hpp>

#include <optional>
#include <span>
#include <string>

namespace incise {

/// The robot program for the final path of a run, and what its checks found.
struct CheckedProgram {
  ToolPath path;         ///< in the robot's frame
  RobotProgram program;  ///< along it
  ProgramChecks checks;
  ProgramHeader header;          ///< of the written program, with its verdict
  std::optional<Replay> replay;  ///< how the arm executes the script; absent if the gate was closed before it
};

/// Results of the whole loop on one specimen.
struct Run {
  Study study;
  Verdict verdict;  ///< from the study, earlier advice against the path, and the program's checks
  std::optional<CheckedProgram> program;
  VerdictGate gate;                 ///< whether the program may be written; closed if there is none
  std::string why_without_program;  ///< empty if there is one
};

/// Runs the whole loop as run_study does, up to the cut along the corrected path. Then makes and checks the robot
/// program: along the corrected path if the correction is accepted, otherwise along the path that was cut first. Failed
/// checks and an incomplete replay are added to the verdict; the gate is open if the verdict allows the program.
/// @param options  `until` is not read: all stages run.
/// @param accepted  ids of the cautions that a person accepts.
/// @throws as run_study and require_place_for_arm; DataError naming the path (Inputs::path_name) if no tool can follow
/// it.
[[nodiscard]] Run run(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
                      std::span<const std::string> accepted, Workers& workers, Monitor& monitor, ProductSink& sink);
/// Runs the same on all threads of the machine, without messages or files.
[[nodiscard]] Run run(const Case& settings, Inputs& inputs, Cache& cache, std::span<const std::string> accepted = {});

/// Copies the arm's settings of a case, or the limits of the checks on its program. Other fields keep their values.
void take_arm(const Case& settings, ArmSetup& setup);
void take_limits(const Case& settings, CheckSettings& limits);

/// Checks that a program can hold the case's tool.
/// @throws CaseError (tool.kind) for a tool that is not round, because a program does not turn the tool into its
/// direction of travel.
void require_round_tool(const Case& settings);

/// Checks the arm's transforms in a case that requests a program (has robot.T_robot_sim).
/// @throws CaseError (robot.T_robot_sim) for a specimen more than 10 m from the base; (robot.T_flange_tool) for a tip
/// nearer to the flange than the needle's length, or more than 10 m from it.
void require_place_for_arm(const Case& settings);

}  // namespace incise
