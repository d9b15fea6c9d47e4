#pragma once

#include <string>
#include <vector>

namespace incise {

struct LineSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;          ///< as many as x
  bool is_line = false;           ///< else one mark per point
  std::vector<double> low = {};   ///< lower ends of error bars along y; empty: no bars, else one per x
  std::vector<double> high = {};  ///< upper ends of the error bars, one per lower end
};

/// A plain x-y plot; labels carry the units.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool is_log_x = false;
  bool is_log_y = false;
  std::vector<LineSeries> series;
};

/// Returns every problem that keeps a plot from being drawn, in words: no series, a series without points, lists of
/// different length, and numbers that are not finite or, on a logarithmic axis, not positive.
[[nodiscard]] std::vector<std::string> find_problems(const LinePlot& plot);

/// Returns a complete SVG document without external references. @throws InvalidArgument with the first problem that
/// find_problems(plot) finds.
[[nodiscard]] std::string line_plot_svg(const LinePlot& plot);

}  // namespace incise
