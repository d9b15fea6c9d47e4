#pragma once

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// One mark for each category.
struct CategorySeries {
  std::string name;
  std::vector<double> values;
  std::vector<double> low = {};       ///< lower ends of error bars; empty: no bars, else one per value
  std::vector<double> high = {};      ///< upper ends of the error bars, one per lower end
  std::optional<double> chance = {};  ///< value expected by chance, drawn as a dashed line
};

/// Series that share an axis. The axis starts at 0, or lower if a value is negative.
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

/// Returns a complete SVG document without external references. @throws InvalidArgument without categories, panels or
/// series, for lists of different length, and for a number that is not finite.
[[nodiscard]] std::string category_plot_svg(const CategoryPlot& plot);

}  // namespace incise
