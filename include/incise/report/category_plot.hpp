#pragma once

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// One mark for each category.
struct CategorySeries {
  std::string name;
  std::vector<double> values;
  std::vector<double> low = {};       ///< lower ends of error bars; empty: none, else as many as values
  std::vector<double> high = {};      ///< their upper ends, as many as lower ones
  std::optional<double> chance = {};  ///< what a value without meaning would be: a dashed line
};

/// Series that share an axis, which begins at or includes 0.
struct CategoryPanel {
  std::string label;  ///< of the axis, with its unit
  std::vector<CategorySeries> series;
};

/// Categories as rows, the first on top; panels side by side.
struct CategoryPlot {
  std::string title;
  std::vector<std::string> categories;
  std::vector<CategoryPanel> panels;
};

/// A complete SVG document without a reference to anything outside. @throws InvalidArgument without categories, panels
/// or series, for lengths that differ, and for a number that is not finite.
[[nodiscard]] std::string category_plot_svg(const CategoryPlot& plot);

}  // namespace incise
