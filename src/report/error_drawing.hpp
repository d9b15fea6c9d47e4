#pragma once

#include "report/plot.hpp"
#include "report/svg.hpp"

#include <string>
#include <string_view>

namespace incise {

/// Shades the errors that leave too little tissue and those that reach the tumour edge, as far as the plot shows them.
void draw_error_zones(SvgWriter& svg, const PlotArea& area, double reached_mm, double close_mm);
/// Draws the zones' names at the right, on a pale rim. Call it after drawing the data, which would otherwise cover the
/// names.
void draw_error_zone_names(SvgWriter& svg, const PlotArea& area, double reached_mm, double close_mm,
                           const std::string& close_name);

/// A box of a box plot of errors, with or without their signs, `2 * half_px` wide.
void draw_error_box(SvgWriter& svg, const PlotArea& area, double center_px, std::vector<double> signed_error_mm,
                    bool is_signed, std::string_view color, double half_px = 24.0);

}  // namespace incise
