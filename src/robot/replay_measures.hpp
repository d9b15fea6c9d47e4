#pragma once

#include <incise/robot/player.hpp>

namespace incise::robot_detail {

/// Down along the axis at the start, along the curve and its overlap, up along the axis at the end.
[[nodiscard]] Points intended_course(const ToolPath& path, const WrittenProgram& program);

/// Distances of the samples from `replay.intended_mm`, the greatest (of all, and in the cut) and the mean of them.
void measure_deviation(Replay& replay);

/// Tip speed in the cut, `end_zone_mm` away from its ends.
void measure_speed(Replay& replay, double end_zone_mm);

/// A completed replay that begins or ends in the tissue gets that outcome. By the surface that the path tells of, or,
/// without one, by the program's phases.
void judge_ends(Replay& replay, const ToolPath* path);

/// A completed replay whose tip leaves the intended course by more than that in the cut gets that outcome.
void judge_deviation(Replay& replay, double max_deviation_mm);

}  // namespace incise::robot_detail
