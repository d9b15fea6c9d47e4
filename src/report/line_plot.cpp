#include "report/plot.hpp"

#include <incise/core/error.hpp>
#include <incise/report/line_plot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace incise {
namespace {

constexpr double kPlotWidth = 560.0;
constexpr double kPlotHeight = 340.0;
constexpr double kLeft = 82.0;  // room for numbers and the axis' name beside them
constexpr double kMarkRadius = 3.2;
constexpr double kTitleCharacter = 7.4;  // approximate width of one character, px
constexpr double kNameCharacter = 6.4;
constexpr double kTitleRow = 18.0;

struct AxisRange {
  double low = 0.0;
  double high = 0.0;
};

/// The range of one axis' values (their logarithms on a log axis), with a margin; never empty.
AxisRange range_of(const LinePlot& plot, bool is_x) {
  const bool is_log = is_x ? plot.is_log_x : plot.is_log_y;
  AxisRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto widen = [&](const std::vector<double>& values) {
    for (const double value : values) {
      const double place = is_log ? std::log10(value) : value;
      range.low = std::min(range.low, place);
      range.high = std::max(range.high, place);
    }
  };
  for (const LineSeries& series : plot.series) {
    widen(is_x ? series.x : series.y);
    if (is_x) continue;
    widen(series.low);
    widen(series.high);
  }
  double air = 0.06 * (range.high - range.low);
  if (!(air > 0.0)) air = std::max(1e-12, 0.5 * std::abs(range.high));
  return {range.low - air, range.high + air};
}

/// Adds the first number that an axis cannot show, if there is one.
void check_numbers(const LineSeries& series, const std::vector<double>& values, bool is_log,
                   std::vector<std::string>& problems) {
  const auto bad = std::find_if(values.begin(), values.end(),
                                [is_log](double value) { return !std::isfinite(is_log ? std::log10(value) : value); });
  if (bad == values.end()) return;
  problems.push_back(
      fmt::format("series \"{}\": expected numbers that the axis can show, found {}", series.name, *bad));
}

/// Ticks at the marks of a logarithmic x axis, if these are few: sizes that double are easier to read than 1, 2, 5.
std::vector<double> mark_ticks(const LinePlot& plot) {
  constexpr std::size_t kMost = 6;
  std::vector<double> ticks;
  for (const LineSeries& series : plot.series) {
    if (series.is_line) continue;
    for (const double value : series.x) ticks.push_back(std::log10(value));
  }
  std::sort(ticks.begin(), ticks.end());
  ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
  if (ticks.size() > kMost) ticks.clear();
  return ticks;
}

/// Ticks at 1, 2, 5 times powers of ten, or at the powers alone where those would crowd.
std::vector<double> log_ticks(const AxisRange& range) {
  std::vector<double> ticks;
  const bool is_wide = range.high - range.low > 2.0;
  const int stride = std::max(1, static_cast<int>(std::ceil((range.high - range.low) / 8.0)));
  for (int decade = static_cast<int>(std::floor(range.low)); decade <= range.high; ++decade) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (is_wide && (factor != 1.0 || decade % stride != 0)) continue;
      const double place = decade + std::log10(factor);
      if (place >= range.low && place <= range.high) ticks.push_back(place);
    }
  }
  return ticks;
}

void draw_axis(SvgWriter& svg, const PlotArea& area, const AxisRange& range, const std::vector<double>& preferred,
               bool is_log, bool is_x, std::string_view name) {
  std::vector<double> ticks = preferred;
  if (ticks.empty()) ticks = is_log ? log_ticks(range) : round_ticks(range.low, range.high, 6);
  if (!is_log) {
    is_x ? draw_x_axis(svg, area, ticks, name) : draw_y_axis(svg, area, ticks, name);
    return;
  }
  // The axis is drawn in logarithms; its numbers are the values.
  is_x ? draw_x_axis(svg, area, {}, name) : draw_y_axis(svg, area, {}, name);
  const double bottom = area.corner.y() + area.size.y();
  for (const double tick : ticks) {
    const double value = std::pow(10.0, tick);
    const std::string text = value < 0.001 ? fmt::format("{:.0e}", value) : number_text(value);
    if (is_x) {
      svg.line({area.x(tick), bottom}, {area.x(tick), bottom + 5.0}, "stroke=\"#555\"");
      svg.text({area.x(tick), bottom + 19.0}, text, "middle");
    } else {
      svg.line({area.corner.x(), area.y(tick)}, {area.corner.x() + area.size.x(), area.y(tick)}, "stroke=\"#d9d9d4\"");
      svg.text({area.corner.x() - 7.0, area.y(tick) + 4.0}, text, "end");
    }
  }
}

void draw_series(SvgWriter& svg, const PlotArea& area, const LinePlot& plot, const LineSeries& series,
                 std::string_view color) {
  const auto at = [&](double x, double y) {
    return area.at(plot.is_log_x ? std::log10(x) : x, plot.is_log_y ? std::log10(y) : y);
  };
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < series.x.size(); ++i) points.push_back(at(series.x[i], series.y[i]));
  for (std::size_t i = 0; i < series.low.size(); ++i) {
    svg.line(at(series.x[i], series.low[i]), at(series.x[i], series.high[i]),
             fmt::format("stroke=\"{}\" stroke-width=\"1.6\"", color));
  }
  if (series.is_line) {
    svg.polyline(points, false, fmt::format("stroke=\"{}\" stroke-width=\"1.8\" fill=\"none\"", color));
    return;
  }
  svg.open_group(fmt::format("fill=\"#fff\" fill-opacity=\"0.6\" stroke=\"{}\" stroke-width=\"1.6\"", color));
  for (const Vec2& p : points) svg.circle(p, kMarkRadius, "");
  svg.close_group();
}

/// The title in rows that fit into the picture, broken between words.
std::vector<std::string> title_rows(const std::string& title) {
  constexpr auto kMost = static_cast<std::size_t>((kPlotWidth - 16.0) / kTitleCharacter);
  std::vector<std::string> rows{""};
  std::istringstream words(title);
  for (std::string word; words >> word;) {
    if (!rows.back().empty() && rows.back().size() + 1 + word.size() > kMost) rows.emplace_back();
    rows.back() += (rows.back().empty() ? "" : " ") + word;
  }
  return rows;
}

void draw_legend(SvgWriter& svg, const LinePlot& plot, const std::vector<Vec2>& places) {
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Vec2& at = places[i];
    if (plot.series[i].is_line) {
      svg.line(at, at + Vec2(16.0, 0.0), fmt::format("stroke=\"{}\" stroke-width=\"1.8\"", ink::of_series(i)));
    } else {
      svg.circle(at + Vec2(8.0, 0.0), kMarkRadius,
                 fmt::format("fill=\"#fff\" stroke=\"{}\" stroke-width=\"1.6\"", ink::of_series(i)));
    }
    svg.text(at + Vec2(21.0, 4.0), plot.series[i].name);
  }
}

}  // namespace

std::vector<std::string> find_problems(const LinePlot& plot) {
  std::vector<std::string> problems;
  if (plot.series.empty()) problems.emplace_back("expected at least one series");
  for (const LineSeries& series : plot.series) {
    if (series.x.empty() || series.x.size() != series.y.size()) {
      problems.push_back(fmt::format("series \"{}\": expected as many y as x, at least one, found {} and {}",
                                     series.name, series.y.size(), series.x.size()));
    }
    if (series.low.size() != series.high.size() || (!series.low.empty() && series.low.size() != series.x.size())) {
      problems.push_back(fmt::format(
          "series \"{}\": expected no error bars or as many as points, {}, found {} lower and {} upper ends",
          series.name, series.x.size(), series.low.size(), series.high.size()));
    }
    check_numbers(series, series.x, plot.is_log_x, problems);
    for (const auto* values : {&series.y, &series.low, &series.high})
      check_numbers(series, *values, plot.is_log_y, problems);
  }
  return problems;
}

std::string line_plot_svg(const LinePlot& plot) {
  const std::vector<std::string> problems = find_problems(plot);
  INCISE_REQUIRE(problems.empty(), problems.front());
  const AxisRange x = range_of(plot, true);
  const AxisRange y = range_of(plot, false);
  const std::vector<std::string> title = title_rows(plot.title);
  std::vector<double> widths;
  for (const LineSeries& series : plot.series)
    widths.push_back(40.0 + kNameCharacter * static_cast<double>(series.name.size()));
  const std::vector<Vec2> legend =
      legend_places(widths, {kLeft, 42.0 + kTitleRow * static_cast<double>(title.size() - 1)}, kPlotWidth, kPlotWidth);
  const double top = legend.back().y() + 16.0;  // of the axes; further legend rows above make the picture taller
  const double height = kPlotHeight + top - 58.0;
  SvgWriter svg(kPlotWidth, height, plot.title, fmt::format("{} against {}", plot.y_label, plot.x_label));
  for (std::size_t i = 0; i < title.size(); ++i) {
    svg.text({0.5 * kPlotWidth, 20.0 + kTitleRow * static_cast<double>(i)}, title[i], "middle",
             "font-weight=\"600\" font-size=\"13\"");
  }
  const PlotArea area{{kLeft, top}, {kPlotWidth - kLeft - 20.0, kPlotHeight - 112.0}, x.low, x.high, y.low, y.high};
  draw_axis(svg, area, y, {}, plot.is_log_y, false, plot.y_label);
  draw_axis(svg, area, x, plot.is_log_x ? mark_ticks(plot) : std::vector<double>{}, plot.is_log_x, true, plot.x_label);
  for (std::size_t i = 0; i < plot.series.size(); ++i) draw_series(svg, area, plot, plot.series[i], ink::of_series(i));
  draw_legend(svg, plot, legend);
  return svg.finish();
}

}  // namespace incise
