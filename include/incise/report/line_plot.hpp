#pragma once

#include <incise/core/line_plot.hpp>

#include <string>
#include <vector>

namespace incise {

/// Returns every problem that keeps a plot from being drawn, in words: no series, a series without points, lists of
/// different length, and numbers that are not finite or, on a logarithmic axis, not positive.
[[nodiscard]] std::vector<std::string> find_problems(const LinePlot& plot);

/// Returns a complete SVG document without external references. @throws InvalidArgument with the first problem that
/// find_problems(plot) finds.
[[nodiscard]] std::string line_plot_svg(const LinePlot& plot);

}  // namespace incise
