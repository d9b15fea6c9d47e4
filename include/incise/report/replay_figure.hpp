#pragma once

#include <incise/geometry/types.hpp>

#include <string>
#include <vector>

namespace incise {

/// A program as the player ran it.
struct ReplayPicture {
  Points intended_mm;                  ///< the intended course of the tip; may be empty
  Points tip_mm;                       ///< the tip while it cuts, N x 3
  std::vector<double> time_s;          ///< N
  std::vector<double> tip_speed_mm_s;  ///< N
  std::vector<double> deviation_mm;    ///< N, distance from the intended course
  Vec3 approach = -Vec3::UnitZ();  ///< direction of view
};

/// Draws, at the left, the true path of the tip (colour) over the intended one (black), seen along the approach, with a
/// scale bar; at the right, the speed of the tip over time and its deviation along the true path. Without an intended
/// course there is no deviation.
/// @returns a complete SVG document. @throws InvalidArgument for fewer than two samples, lists of different length, or
/// a number that is not finite.
[[nodiscard]] std::string replay_figure_svg(const ReplayPicture& picture);

}  // namespace incise
