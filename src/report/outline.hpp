#pragma once

#include <span>
#include <string>

namespace incise {

/// Border between values below and above `level` on a grid of picture elements (rows from the top), as SVG path data.
/// Marching squares with linear interpolation; a value sits at the centre of its element. Lines end at the picture's
/// border.
/// @param dx, dy  size of an element in the path's unit.  @pre values.size() == columns * rows.
[[nodiscard]] std::string outline_path(std::span<const double> values, int columns, int rows, double level, double dx,
                                       double dy);

}  // namespace incise
