#include "report/sections.hpp"
#include "report/tables.hpp"

#include <incise/report/line_plot.hpp>

namespace incise {

std::string kerf_section(const ReportData& data) {
  const std::string heading = "<section>\n<h2 id=\"kerf\">The kerf</h2>\n";
  if (data.kerf_plots.empty() && data.kerf_figures.empty() && data.kerf_layers.rows.empty()) {
    return heading + "<p class=\"missing\">There are no measures of the kerf here.</p>\n</section>\n";
  }
  std::string html = heading +
                     "<p class=\"lead\">All values are simulated. Depth is measured below the skin of "
                     "the stretched, uncut tissue, along the approach. Lag and drift are how far tissue, when it was "
                     "cut, was displaced from its place in the stretched, uncut tissue: "
                     "along the tool's course, and across it.</p>\n<div class=\"figures\">\n";
  for (const LinePlot& plot : data.kerf_plots) html += "<figure>" + line_plot_svg(plot) + "</figure>\n";
  for (const std::string& figure : data.kerf_figures) html += "<figure>" + figure + "</figure>\n";
  html += "</div>\n";
  if (!data.kerf_layers.rows.empty()) html += free_table(data.kerf_layers);
  return html + "</section>\n";
}

}  // namespace incise
