#include "report/error_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {

namespace {

/// Calls `draw` with the part of each zone that the plot shows.
template <typename Draw>
void for_each_zone(const PlotArea& area, double reached_mm, double close_mm, const std::string& close_name,
                   const Draw& draw) {
  const auto band = [&](double from, double to, std::string_view color, const std::string& name) {
    const double low = std::max(from, area.y_low);
    const double high = std::min(to, area.y_high);
    if (high > low) draw(low, high, color, name);
  };
  band(reached_mm, close_mm, ink::kTooClose, close_name);
  band(-1e9, reached_mm, ink::kReached, "tumour edge reached");
}

/// @param end_px  lower right corner of the text
void draw_zone_name(SvgWriter& svg, const Vec2& end_px, const std::string& name, std::string_view color) {
  svg.text(end_px, name, "end",
           "font-size=\"12\" fill=\"#fff\" stroke=\"#fff\" stroke-width=\"4\" stroke-linejoin=\"round\"");
  svg.text(end_px, name, "end",
           fmt::format("font-size=\"12\" fill=\"{}\"", color == ink::kTooClose ? ink::kTooCloseText : color));
}

}  // namespace

void draw_error_zones(SvgWriter& svg, const PlotArea& area, double reached_mm, double close_mm) {
  for_each_zone(area, reached_mm, close_mm, "", [&](double low, double high, std::string_view color, const auto&) {
    svg.rectangle({area.corner.x(), area.y(high)}, {area.size.x(), area.y(low) - area.y(high)},
                  fmt::format("fill=\"{}\" fill-opacity=\"0.16\"", color));
  });
}

void draw_error_zone_names(SvgWriter& svg, const PlotArea& area, double reached_mm, double close_mm,
                           const std::string& close_name) {
  constexpr double kLeastHeightPx = 14.0;
  for_each_zone(area, reached_mm, close_mm, close_name,
                [&](double low, double high, std::string_view color, const std::string& name) {
                  if (area.y(low) - area.y(high) <= kLeastHeightPx) return;
                  draw_zone_name(svg, {area.corner.x() + area.size.x() - 6.0, area.y(high) + 13.0}, name, color);
                });
}

void draw_error_box(SvgWriter& svg, const PlotArea& area, double center_px, std::vector<double> signed_error_mm,
                    bool is_signed, std::string_view color, double half_px) {
  if (!is_signed) {
    for (double& error : signed_error_mm) error = std::abs(error);
  }
  const BoxNumbers box = box_numbers(signed_error_mm);
  const std::string stroke = fmt::format("stroke=\"{}\" stroke-width=\"1.6\"", color);
  const auto at = [&](double dx, double value) { return Vec2(center_px + dx, area.y(value)); };
  svg.line(at(0.0, box.low_whisker), at(0.0, box.lower_quartile), stroke);
  svg.line(at(0.0, box.upper_quartile), at(0.0, box.high_whisker), stroke);
  svg.line(at(-half_px / 2, box.low_whisker), at(half_px / 2, box.low_whisker), stroke);
  svg.line(at(-half_px / 2, box.high_whisker), at(half_px / 2, box.high_whisker), stroke);
  svg.rectangle(at(-half_px, box.upper_quartile),
                {2.0 * half_px, std::max(1.0, area.y(box.lower_quartile) - area.y(box.upper_quartile))},
                fmt::format("fill=\"{}\" fill-opacity=\"0.18\" {}", color, stroke));
  svg.line(at(-half_px, box.median), at(half_px, box.median), fmt::format("stroke=\"{}\" stroke-width=\"3\"", color));
  const Vec2 mean = at(0.0, box.mean);
  const std::array<Vec2, 4> diamond{mean + Vec2(-5, 0), mean + Vec2(0, -5), mean + Vec2(5, 0), mean + Vec2(0, 5)};
  svg.polyline(diamond, true, fmt::format("fill=\"#fff\" stroke=\"{}\" stroke-width=\"1.5\"", color));
  for (const double outlier : box.outliers) {
    svg.circle(at(0.0, outlier), 2.2, fmt::format("fill=\"none\" stroke=\"{}\"", color));
  }
}

}  // namespace incise
