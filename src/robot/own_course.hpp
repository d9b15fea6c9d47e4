#pragma once

#include <incise/robot/player.hpp>

namespace incise::robot_detail {

/// Sets a replay's outcome and reason. @param line  of the program, from 1; 0: no line is to blame
void end_replay(Replay& replay, ReplayOutcome outcome, std::string reason = {}, std::size_t line = 0);

/// Compares a completed replay with the course of the path and settings in its program's header, in all phases:
/// position, axis, order, speed and rests. Sets the outcome to the first fault. Without path and settings in the
/// header, it does nothing.
void judge_own_course(Replay& replay, const WrittenProgram& program, const PlayerSettings& settings);

/// Compares a completed replay with the limits of the arm's checks, those in the header or else the defaults: table,
/// tool_table, self_collision, base, joint_limits and singularity. Checks that the header lists as overridden are
/// skipped.
void judge_limits(Replay& replay, const WrittenProgram& program, const ArmModel& arm);

/// Returns whether the header lists this check as overridden.
[[nodiscard]] bool is_overridden(const ProgramHeader& header, const std::string& check);

}  // namespace incise::robot_detail
