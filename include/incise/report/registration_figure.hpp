#pragma once

#include <incise/geometry/types.hpp>

#include <span>
#include <string>
#include <vector>

namespace incise {

/// Content of a figure of a registration.
struct RegistrationFigure {
  std::string title;
  std::string subtitle;
  Points target_mm;                  ///< grey
  Points moved_source_mm;            ///< blue, moved by the transform
  std::vector<double> residuals_mm;  ///< distances along the normals; empty: no histogram
  Vec3 approach = -Vec3::UnitZ();    ///< line of sight of the overlay
};

/// Draws both clouds as seen along the approach and, below, from the side, and a histogram of the residuals. At most
/// 3000 points of each cloud are drawn, evenly chosen.
/// @returns a complete SVG document without external references. @throws InvalidArgument unless both clouds have
/// points, or for a number that is not finite.
[[nodiscard]] std::string registration_figure_svg(const RegistrationFigure& figure);

}  // namespace incise
