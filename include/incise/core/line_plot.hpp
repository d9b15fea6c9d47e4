#pragma once

#include <string>
#include <vector>

namespace incise {

/// One series of a plot.
struct LineSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;          ///< as many as x
  bool is_line = false;           ///< else one mark per point
  std::vector<double> low = {};   ///< lower ends of error bars along y; empty: no bars, else one per x
  std::vector<double> high = {};  ///< upper ends of the error bars, one per lower end
  /// Adds the point (at, value), in the units of the axes.
  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
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

}  // namespace incise
