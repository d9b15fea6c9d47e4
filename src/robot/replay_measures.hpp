#pragma once

#include <incise/robot/player.hpp>

namespace incise::robot_detail {

/// Returns the intended course of the tip as a polyline, robot frame, mm: down along the axis at the start, along the
/// curve and its overlap, up along the axis at the end.
[[nodiscard]] Points intended_course(const ToolPath& path, const WrittenProgram& program);

/// Measures the distances of the samples from `replay.intended_mm`: the greatest of all, the greatest and the mean in
/// the cut.
void measure_deviation(Replay& replay);

/// Measures the tip's speed in the cut, more than `end_zone_mm` away from its ends.
void measure_speed(Replay& replay, double end_zone_mm);

/// Sets the outcome of a completed replay that begins or ends in the tissue. Judges by the path's entry points or,
/// without a path, by the program's phases.
void judge_ends(Replay& replay, const ToolPath* path);

/// Sets the outcome of a completed replay whose tip leaves the intended course in the cut by more than this.
void judge_deviation(Replay& replay, double max_deviation_mm);

}  // namespace incise::robot_detail
