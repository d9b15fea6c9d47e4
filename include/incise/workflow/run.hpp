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

/// The robot program for the path that a run ended with, and what its checks found.
struct CheckedProgram {
  ToolPath path;         ///< in the robot's frame
  RobotProgram program;  ///< along it
  ProgramChecks checks;
  ProgramHeader header;          ///< what the written program says of itself, its verdict included
  std::optional<Replay> replay;  ///< what the arm does with the script; absent where the gate was closed before it
};

/// The whole loop on one specimen.
struct Run {
  Study study;
  Verdict verdict;  ///< of the study, of earlier advice against the path, and of the program's checks
  std::optional<CheckedProgram> program;
  VerdictGate gate;                 ///< whether the program may be written; closed where there is none
  std::string why_without_program;  ///< empty where there is one
};

/// Runs the whole loop as run_study does, up to the cut along the corrected path, then makes and checks the robot
/// program: along the corrected path where the correction is accepted, else along the path that was cut first. Failed
/// checks, and a replay that does not complete, join the verdict; the gate is open if the verdict allows the program.
/// @param options  `until` is not read: all stages run.
/// @param accepted  ids of the cautions that a person takes on them.
/// @throws as run_study; CaseError (robot.T_robot_sim, robot.T_flange_tool) for a place that no arm works at; DataError
/// naming the path (Inputs::path_name) where no tool can follow it.
[[nodiscard]] Run run(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
                      std::span<const std::string> accepted, Workers& workers, Monitor& monitor, ProductSink& sink);
/// The same on every thread of the machine, without messages and files.
[[nodiscard]] Run run(const Case& settings, Inputs& inputs, Cache& cache, std::span<const std::string> accepted = {});

/// What a case that asks for a program has to hold.
/// @throws CaseError (robot.T_robot_sim, robot.T_flange_tool) for a place that no arm works at.
void require_place_for_arm(const Case& settings);

}  // namespace incise
