#pragma once

#include <string>
#include <vector>

namespace incise {

struct LineSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;          ///< as many as x
  bool is_line = false;           ///< else one mark per point
  std::vector<double> low = {};   ///< lower ends of error bars along y; empty: none, else as many as x
  std::vector<double> high = {};  ///< their upper ends, as many as lower ones
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

/// A complete SVG document without a reference to anything outside. @throws InvalidArgument without points, for lengths
/// that differ, and for a number that is not finite or, on a logarithmic axis, not positive.
[[nodiscard]] std::string line_plot_svg(const LinePlot& plot);

}  // namespace incise
