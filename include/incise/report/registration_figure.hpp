#pragma once

#include <incise/geometry/types.hpp>

#include <span>
#include <string>
#include <vector>

namespace incise {

/// What the picture of a registration shows.
struct RegistrationFigure {
  std::string title;
  std::string subtitle;
  Points target_mm;                  ///< grey
  Points moved_source_mm;            ///< blue, where the transform lays it
  std::vector<double> residuals_mm;  ///< distances along the normals
  Vec3 approach = -Vec3::UnitZ();    ///< line of sight of the overlay
};

/// Both clouds seen along the approach, from the side below it, and a histogram of the residuals. At most 3000 points
/// of each cloud are drawn, evenly chosen. A complete SVG document without a reference to anything outside.
/// @throws InvalidArgument without points, or for a number that is not finite.
[[nodiscard]] std::string registration_figure_svg(const RegistrationFigure& figure);

}  // namespace incise
