#pragma once

#include <incise/geometry/types.hpp>

#include <string>
#include <vector>

namespace incise {

/// A program as a player ran it.
struct ReplayPicture {
  Points intended_mm;                  ///< the tip's intended course; may be empty
  Points tip_mm;                       ///< the tip in the cut, N x 3
  std::vector<double> time_s;          ///< N
  std::vector<double> tip_speed_mm_s;  ///< N
  std::vector<double> deviation_mm;    ///< N, from the intended course
  Vec3 approach = -Vec3::UnitZ();  ///< direction in which the picture looks
};

/// Left: the tip's true path (colour) over the intended one (black), seen along the approach, with a scale bar. Right:
/// tip speed over time, and the deviation along the tip's way. A complete SVG document. @throws InvalidArgument for fewer than two samples,
/// lengths that differ, or a number that is not finite.
[[nodiscard]] std::string replay_figure_svg(const ReplayPicture& picture);

}  // namespace incise
