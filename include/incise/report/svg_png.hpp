#pragma once

#include <string>
#include <string_view>

namespace incise {

/// A figure (SVG text) as a PNG file in memory, on white, `scale` pixels per SVG pixel. Drawn by librsvg with whatever
/// sans-serif font the machine has, so that its bytes differ between machines.
/// @pre scale in (0, 10], sides of 1 to 20 000 pixels.  @throws Error if the text cannot be drawn.
[[nodiscard]] std::string png_of_svg(std::string_view svg, double scale = 2.0);

}  // namespace incise
