#pragma once

#include <incise/robot/player.hpp>

namespace incise::robot_detail {

/// A completed replay is held to the course that its program's header tells of, in all phases: place, axis, order,
/// speed and rests. Without such a header nothing is known.
void judge_own_course(Replay& replay, const WrittenProgram& program, const PlayerSettings& settings);

/// A completed replay is held to the limits of the arm's checks, those of the header or else the defaults: table, tool
/// above the table, itself, base, joint limits, singularity. What the header says to be overridden is left out.
void judge_limits(Replay& replay, const WrittenProgram& program, const ArmModel& arm);

/// Whether the header says that a person took this check on them.
[[nodiscard]] bool is_overridden(const ProgramHeader& header, const std::string& check);

}  // namespace incise::robot_detail
