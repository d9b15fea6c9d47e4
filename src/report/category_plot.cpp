#include "report/plot.hpp"

#include <incise/core/error.hpp>
#include <incise/report/category_plot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kPanelWidth = 330.0;
constexpr double kPanelGap = 24.0;
constexpr double kRow = 24.0;
constexpr double kPanelTop = 66.0;  // room for the title and the legends
constexpr double kBelow = 52.0;     // for numbers and the axis' name
constexpr double kCharacterWidth = 7.0;

void require_plot(const CategoryPlot& plot) {
  INCISE_REQUIRE(!plot.categories.empty() && !plot.panels.empty(), "expected categories and panels");
  for (const CategoryPanel& panel : plot.panels) {
    INCISE_REQUIRE(!panel.series.empty(), fmt::format("panel \"{}\": expected a series", panel.label));
    for (const CategorySeries& series : panel.series) {
      const std::size_t bars = series.low.size();
      INCISE_REQUIRE(
          series.values.size() == plot.categories.size() && series.high.size() == bars &&
              (bars == 0 || bars == series.values.size()),
          fmt::format("series \"{}\": expected {} values and error bars for all or none, found {}, {} and {}",
                      series.name, plot.categories.size(), series.values.size(), bars, series.high.size()));
      for (const auto* list : {&series.values, &series.low, &series.high})
        for (const double value : *list)
          INCISE_REQUIRE(std::isfinite(value), fmt::format("series \"{}\": expected finite numbers", series.name));
      INCISE_REQUIRE(!series.chance || std::isfinite(*series.chance), "expected a finite line of chance");
    }
  }
}

PlotArea area_of(const CategoryPanel& panel, const Vec2& corner, double height) {
  double low = 0.0, high = 0.0;
  const auto widen = [&](double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const CategorySeries& series : panel.series) {
    for (const auto* list : {&series.values, &series.low, &series.high})
      for (const double value : *list) widen(value);
    if (series.chance) widen(*series.chance);
  }
  const double air = std::max(0.05 * (high - low), 1e-9);
  return {corner, {kPanelWidth, height}, low < 0.0 ? low - air : 0.0, high + air, 0.0, 1.0};
}

void draw_marks(SvgWriter& svg, const PlotArea& area, const CategorySeries& series, double shift,
                std::string_view color) {
  const double bottom = area.corner.y() + area.size.y();
  if (series.chance) {
    svg.line({area.x(*series.chance), area.corner.y()}, {area.x(*series.chance), bottom},
             fmt::format("stroke=\"{}\" stroke-dasharray=\"4 3\"", color));
  }
  for (std::size_t k = 0; k < series.values.size(); ++k) {
    const double y = area.corner.y() + kRow * (static_cast<double>(k) + 0.5) + shift;
    if (!series.low.empty())
      svg.line({area.x(series.low[k]), y}, {area.x(series.high[k]), y},
               fmt::format("stroke=\"{}\" stroke-width=\"1.6\"", color));
    svg.circle({area.x(series.values[k]), y}, 3.4, fmt::format("fill=\"{}\"", color));
  }
}

void draw_legend_of(SvgWriter& svg, const CategoryPanel& panel, const PlotArea& area) {
  Vec2 at = area.corner + Vec2(4.0, -14.0);
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    svg.circle(at + Vec2(0.0, -4.0), 3.4, fmt::format("fill=\"{}\"", ink::of_series(i)));
    svg.text(at + Vec2(9.0, 0.0), panel.series[i].name);
    at.x() += 28.0 + kCharacterWidth * static_cast<double>(panel.series[i].name.size());
  }
}

}  // namespace

std::string category_plot_svg(const CategoryPlot& plot) {
  require_plot(plot);
  std::size_t longest = 0;
  for (const std::string& name : plot.categories) longest = std::max(longest, name.size());
  const double left = 16.0 + kCharacterWidth * static_cast<double>(longest);
  const double rows = kRow * static_cast<double>(plot.categories.size());
  const auto panels = static_cast<double>(plot.panels.size());
  const double width = left + panels * (kPanelWidth + kPanelGap);
  SvgWriter svg(width, kPanelTop + rows + kBelow, plot.title, "One mark for each category.");
  svg.text({0.5 * width, 22.0}, plot.title, "middle", "font-weight=\"600\" font-size=\"13\"");
  for (std::size_t k = 0; k < plot.categories.size(); ++k) {
    const double top = kPanelTop + kRow * static_cast<double>(k);
    if (k % 2 == 0) svg.rectangle({0.0, top}, {width, kRow}, "fill=\"#f3f3ef\"");
    svg.text({left - 8.0, top + 0.5 * kRow + 4.0}, plot.categories[k], "end");
  }
  for (std::size_t p = 0; p < plot.panels.size(); ++p) {
    const CategoryPanel& panel = plot.panels[p];
    const PlotArea area = area_of(panel, {left + static_cast<double>(p) * (kPanelWidth + kPanelGap), kPanelTop}, rows);
    for (const double tick : round_ticks(area.x_low, area.x_high, 6))
      svg.line({area.x(tick), kPanelTop}, {area.x(tick), kPanelTop + rows}, "stroke=\"#d9d9d4\"");
    if (area.x_low < 0.0) svg.line({area.x(0.0), kPanelTop}, {area.x(0.0), kPanelTop + rows}, "stroke=\"#555\"");
    draw_x_axis(svg, area, round_ticks(area.x_low, area.x_high, 6), panel.label);
    const auto count = static_cast<double>(panel.series.size());
    for (std::size_t i = 0; i < panel.series.size(); ++i)
      draw_marks(svg, area, panel.series[i], (static_cast<double>(i) - 0.5 * (count - 1.0)) * 6.0, ink::of_series(i));
    if (panel.series.size() > 1) draw_legend_of(svg, panel, area);
  }
  return svg.finish();
}

}  // namespace incise
