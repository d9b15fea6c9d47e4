#include "report/error_drawing.hpp"
#include "report/plot.hpp"
#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/report/comparison_figures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr std::string_view kBefore = ink::kSeries[0];
constexpr std::string_view kAfter = ink::kSeries[1];
/// Colours of the incisions of one side: the side's hue in different lightness.
constexpr std::array<std::string_view, 4> kBeforeShades{"#6b6b6b", "#a3a39c", "#3d3d3d", "#8a7f6d"};
constexpr std::array<std::string_view, 4> kAfterShades{"#0072b2", "#56b4e9", "#013f66", "#2f93cf"};

void require_series(std::span<const ErrorSeries> series) {
  INCISE_REQUIRE(!series.empty(), "expected at least one incision");
  for (const ErrorSeries& one : series) {
    INCISE_REQUIRE(!one.signed_error_mm.empty(), fmt::format("incision \"{}\": expected errors", one.name));
    for (const double error : one.signed_error_mm) {
      INCISE_REQUIRE(std::isfinite(error), fmt::format("incision \"{}\": an error is not finite", one.name));
    }
  }
}

/// Covers all errors and shows a little of every zone that is drawn.
double limit_of(std::span<const ErrorSeries> series, const std::optional<ZoneBorders>& zones) {
  double largest = zones ? -zones->positive_mm + 0.4 : 0.5;
  for (const ErrorSeries& one : series) {
    for (const double error : one.signed_error_mm) largest = std::max(largest, std::abs(error));
  }
  return std::ceil(2.0 * largest) / 2.0;
}

struct Box {
  std::string name;
  std::string_view color;
  std::vector<double> signed_error_mm;
};

std::vector<Box> boxes_of(std::span<const ErrorSeries> series) {
  std::vector<Box> boxes;
  for (const bool is_after : {false, true}) {
    Box all{.name = is_after ? "after" : "before", .color = is_after ? kAfter : kBefore, .signed_error_mm = {}};
    for (const ErrorSeries& one : series) {
      if (one.is_after != is_after) continue;
      all.signed_error_mm.insert(all.signed_error_mm.end(), one.signed_error_mm.begin(), one.signed_error_mm.end());
    }
    if (!all.signed_error_mm.empty()) boxes.push_back(std::move(all));
  }
  for (const ErrorSeries& one : series) {
    boxes.push_back({one.name, one.is_after ? kAfter : kBefore, one.signed_error_mm});
  }
  return boxes;
}

constexpr double kLeastPitch = 62.0;  // from box to box, px
constexpr double kCharacter = 7.2;    // of a name, px

/// How wide the longest name is, px.
double widest_name(const std::vector<Box>& boxes) {
  std::size_t longest = 0;
  for (const Box& box : boxes) longest = std::max(longest, box.name.size());
  return kCharacter * static_cast<double>(longest);
}

/// Draws a name beneath its box: level if all names fit, else all are slanted. Names are never shortened.
void draw_name(SvgWriter& svg, const Vec2& at, const std::string& name, bool is_slanted) {
  if (!is_slanted) {
    svg.text(at, name, "middle");
    return;
  }
  svg.text(at, name, "end", fmt::format("transform=\"rotate(-35 {:.2f} {:.2f})\"", at.x(), at.y()));
}

/// Draws the zones of errors towards the tumour on the axis of absolute errors.
void draw_absolute_zones(SvgWriter& svg, const PlotArea& area, const ZoneBorders& zones) {
  const auto band = [&](double from, double to, std::string_view color) {
    const double high = std::min(to, area.y_high);
    if (high <= from) return;
    svg.rectangle({area.corner.x(), area.y(high)}, {area.size.x(), area.y(from) - area.y(high)},
                  fmt::format("fill=\"{}\" fill-opacity=\"0.16\"", color));
  };
  band(-zones.too_close_mm, -zones.positive_mm, ink::kTooClose);
  band(-zones.positive_mm, 1e9, ink::kReached);
}

/// Draws the zones' names beneath the panels: boxes fill a panel from end to end, so a name among them would lie on a
/// whisker.
void draw_zone_key(SvgWriter& svg, const Vec2& middle) {
  constexpr double kHalfWidth = 250.0;
  Vec2 at = middle - Vec2(kHalfWidth, 0.0);
  const auto entry = [&](std::string_view color, const char* name, double width) {
    svg.rectangle(at - Vec2(0.0, 9.0), {14.0, 10.0},
                  fmt::format("fill=\"{}\" fill-opacity=\"0.16\" stroke=\"{}\"", color, color));
    svg.text(at + Vec2(20.0, 0.0), name, "start", "font-size=\"12\"");
    at.x() += width;
  };
  entry(ink::kTooClose, "too close", 95.0);
  entry(ink::kReached, "tumour edge reached", 160.0);
  svg.text(at, "in a): where the error is towards the tumour", "start", "font-size=\"12\" fill=\"#555\"");
}

void draw_panel(SvgWriter& svg, const PlotArea& area, const std::vector<Box>& boxes, bool is_signed,
                const std::optional<ZoneBorders>& zones) {
  if (zones && is_signed) draw_error_zones(svg, area, zones->positive_mm, zones->too_close_mm);
  if (zones && !is_signed) draw_absolute_zones(svg, area, *zones);
  draw_y_axis(svg, area, round_ticks(area.y_low, area.y_high, 10), is_signed ? "signed error, mm" : "|error|, mm");
  if (is_signed)
    svg.line({area.corner.x(), area.y(0.0)}, {area.corner.x() + area.size.x(), area.y(0.0)}, "stroke=\"#555\"");
  draw_x_axis(svg, area, {}, "");
  svg.text(area.corner + Vec2(0.0, -10.0), is_signed ? "b) with sign: negative = too close" : "a) absolute", "start",
           "font-weight=\"600\"");
  const double pitch = area.size.x() / static_cast<double>(boxes.size());
  const bool is_slanted = widest_name(boxes) > pitch;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const double center = area.corner.x() + pitch * (static_cast<double>(k) + 0.5);
    draw_error_box(svg, area, center, boxes[k].signed_error_mm, is_signed, boxes[k].color,
                   std::min(24.0, 0.36 * pitch));
    draw_name(svg, {center, area.corner.y() + area.size.y() + 17.0}, boxes[k].name, is_slanted);
  }
}

/// Errors in the order of the clock, both ends at 12 o'clock.
std::vector<Vec2> round_the_clock(const ErrorSeries& series) {
  INCISE_REQUIRE(series.clock_h.size() == series.signed_error_mm.size(),
                 fmt::format("incision \"{}\": found {} clock positions for {} errors, expected one each", series.name,
                             series.clock_h.size(), series.signed_error_mm.size()));
  std::vector<Vec2> curve;
  for (std::size_t i = 0; i < series.clock_h.size(); ++i) {
    INCISE_REQUIRE(series.clock_h[i] >= 0.0 && series.clock_h[i] < 12.0, "expected clock positions in [0, 12)");
    curve.emplace_back(series.clock_h[i], series.signed_error_mm[i]);
  }
  std::stable_sort(curve.begin(), curve.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
  return curve;
}

/// Drawn in pieces: where the cut is missing for more than a third of an hour, so is the line.
void draw_curve(SvgWriter& svg, const PlotArea& area, std::vector<Vec2> curve, const std::string& style) {
  constexpr double kGapHours = 0.34;
  const Vec2 first = curve.front();
  const Vec2 last = curve.back();
  const double seam = first.x() + 12.0 - last.x();
  if (seam <= kGapHours) {
    const double at_twelve = last.y() + (12.0 - last.x()) / seam * (first.y() - last.y());
    curve.insert(curve.begin(), Vec2(0.0, at_twelve));
    curve.emplace_back(12.0, at_twelve);
  }
  std::vector<Vec2> piece;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (i > 0 && curve[i].x() - curve[i - 1].x() > kGapHours) {
      svg.polyline(piece, false, style);
      piece.clear();
    }
    piece.push_back(area.at(curve[i].x(), curve[i].y()));
  }
  svg.polyline(piece, false, style);
}

}  // namespace

std::string comparison_box_plot_svg(std::span<const ErrorSeries> series, const std::optional<ZoneBorders>& zones) {
  require_series(series);
  const double limit = limit_of(series, zones);
  const std::vector<Box> boxes = boxes_of(series);
  const double panel = std::max(250.0, kLeastPitch * static_cast<double>(boxes.size()));
  const double width = 70.0 + panel + 80.0 + panel + 16.0;
  const double name_px = widest_name(boxes);
  const bool is_slanted = name_px > panel / static_cast<double>(boxes.size());
  const double height = 420.0 + (is_slanted ? 0.58 * name_px : 0.0);
  SvgWriter svg(width, height, "Distribution of the errors before and after",
                "Box plots of the absolute and of the signed error; line: median, diamond: mean, box: quartiles.");
  for (const bool is_signed : {false, true}) {
    const PlotArea area{.corner = {is_signed ? 150.0 + panel : 70.0, 36.0},
                        .size = {panel, 300.0},
                        .y_low = is_signed ? -limit : 0.0,
                        .y_high = limit};
    draw_panel(svg, area, boxes, is_signed, zones);
  }
  if (zones) draw_zone_key(svg, {width / 2.0, height - 38.0});
  svg.text({width / 2.0, height - 14.0},
           "line: median · diamond: mean · box: quartiles · whiskers: 1.5 interquartile ranges", "middle",
           "font-size=\"12\" fill=\"#555\"");
  return svg.finish();
}

std::string error_by_clock_svg(std::span<const ErrorSeries> series, const std::optional<ZoneBorders>& zones) {
  require_series(series);
  const double limit = limit_of(series, zones);
  std::vector<double> widths;
  for (const ErrorSeries& one : series) widths.push_back(50.0 + 7.0 * static_cast<double>(one.name.size()));
  constexpr double kFirstRight = 560.0;  // beyond it is the key to dashed and full lines
  const std::vector<Vec2> legend = legend_places(widths, {70.0, 24.0}, 760.0, kFirstRight);
  const double more = legend.back().y() - legend.front().y();  // rows of the legend beyond the first
  const PlotArea area{
      .corner = {70.0, 50.0 + more}, .size = {670.0, 310.0}, .x_high = 12.0, .y_low = -limit, .y_high = limit};
  SvgWriter svg(760.0, 420.0 + more, "Signed error by clock position",
                "The error of each point against where it lies on a clock face over the tumour.");
  if (zones) draw_error_zones(svg, area, zones->positive_mm, zones->too_close_mm);
  draw_y_axis(svg, area, round_ticks(-limit, limit, 10), "signed error, mm");
  svg.line(area.at(0.0, 0.0), area.at(12.0, 0.0), "stroke=\"#555\" stroke-width=\"1.2\"");
  draw_x_axis(svg, area, {}, "clock position, h (12: up in the picture unless set)");
  for (int hour = 0; hour <= 12; ++hour) {
    svg.line(area.at(hour, -limit), area.at(hour, -limit) + Vec2(0.0, 5.0), "stroke=\"#555\"");
    svg.text(area.at(hour, -limit) + Vec2(0.0, 19.0), std::to_string(hour == 0 ? 12 : hour), "middle");
  }
  std::array<std::size_t, 2> used{};
  for (std::size_t i = 0; i < series.size(); ++i) {
    const ErrorSeries& one = series[i];
    const auto& shades = one.is_after ? kAfterShades : kBeforeShades;
    const std::string_view color = shades[used[one.is_after ? 1 : 0]++ % shades.size()];
    const std::string style = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}", color,
                                          one.is_after ? "" : " stroke-dasharray=\"6 3\"");
    draw_curve(svg, area, round_the_clock(one), style);
    svg.line(legend[i], legend[i] + Vec2(22.0, 0.0), style);
    svg.text(legend[i] + Vec2(28.0, 4.0), one.name);
  }
  if (zones) draw_error_zone_names(svg, area, zones->positive_mm, zones->too_close_mm, "too close");
  svg.text({740.0, 28.0}, "dashed: before · full: after", "end", "font-size=\"12\" fill=\"#555\"");
  return svg.finish();
}

}  // namespace incise
