#pragma once

#include <string>
#include <string_view>

namespace incise {

/// Returns a figure (SVG text) as a PNG file in memory, on white, with `scale` pixels per SVG pixel. librsvg draws it
/// with the machine's own sans-serif font, so the bytes differ between machines.
/// @pre scale in (0, 10]; sides of 1 to 20 000 pixels. @throws InvalidArgument otherwise; Error if the text cannot be
/// drawn.
[[nodiscard]] std::string png_of_svg(std::string_view svg, double scale = 2.0);

}  // namespace incise
