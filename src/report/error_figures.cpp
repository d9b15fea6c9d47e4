#include "report/error_drawing.hpp"
#include "report/plot.hpp"
#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/core/quantile.hpp>
#include <incise/core/units.hpp>
#include <incise/report/figures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// One point of the error curve: where on the ring (degrees) or along the cut (mm), and the error there.
using PlacedError = std::pair<double, double>;

/// Angles about the centre of the tumour edge (or of the incision), counter-clockwise, 0 where the intended path
/// starts.
std::vector<PlacedError> by_angle(const ReportIncision& incision, const Vec3& approach) {
  const ViewFrame view = view_along(approach);
  const Contour& ring = incision.tumor_edge.points.size() >= 3 ? incision.tumor_edge : incision.incision;
  const Vec3 center = view.to_view(curve_centroid(ring));
  const auto angle = [&](const Vec3& p) {
    const Vec3 q = view.to_view(p) - center;
    return std::atan2(q.y(), q.x());
  };
  const Contour& path = incision.intended_path.points.empty() ? incision.incision : incision.intended_path;
  const double zero = angle(path.points.front());
  std::vector<PlacedError> result;
  for (std::size_t i = 0; i < incision.incision.points.size(); ++i) {
    const double degrees = units::deg_from_rad(angle(incision.incision.points[i]) - zero);
    result.emplace_back(degrees - 360.0 * std::floor(degrees / 360.0), incision.signed_error_mm[i]);
  }
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  // The ring goes on beyond 360 degrees: both ends of the curve get the value between its last and its first point.
  const auto [last, last_error] = result.back();
  const auto [first, first_error] = result.front();
  const double share = first / (first + 360.0 - last);
  const double seam = share * last_error + (1.0 - share) * first_error;
  if (first > 0.0) result.insert(result.begin(), {0.0, seam});
  result.emplace_back(360.0, seam);
  return result;
}

std::vector<PlacedError> by_arc(const ReportIncision& incision) {
  const std::vector<double> arc = arclengths_mm(incision.incision.points);
  std::vector<PlacedError> result;
  for (std::size_t i = 0; i < arc.size(); ++i) result.emplace_back(arc[i], incision.signed_error_mm[i]);
  return result;
}

void draw_zones(SvgWriter& svg, const PlotArea& area, const ReportIncision& incision) {
  draw_error_zones(svg, area, incision.reached_error_mm(), incision.close_error_mm());
}

void draw_zone_names(SvgWriter& svg, const PlotArea& area, const ReportIncision& incision) {
  draw_error_zone_names(svg, area, incision.reached_error_mm(), incision.close_error_mm(),
                        fmt::format("closer than {} mm", number_text(incision.close_margin_mm)));
}

void draw_series_legend(SvgWriter& svg, std::span<const ReportIncision> incisions, Vec2 at) {
  for (std::size_t k = 0; k < incisions.size(); ++k) {
    svg.line(at, at + Vec2(20.0, 0.0),
             fmt::format("stroke=\"{}\" stroke-width=\"2.4\"{}", ink::of_series(k),
                         k == 0 ? " stroke-dasharray=\"5 3\"" : ""));
    svg.text(at + Vec2(26.0, 4.0), incisions[k].name);
    at.x() += 48.0 + 7.0 * static_cast<double>(incisions[k].name.size());
  }
}

void require_incisions(std::span<const ReportIncision> incisions) {
  INCISE_REQUIRE(!incisions.empty(), "expected at least one incision");
  for (const ReportIncision& incision : incisions) require_drawable(incision);
}

}  // namespace

std::string error_by_angle_svg(std::span<const ReportIncision> incisions, const FigureStyle& style) {
  require_incisions(incisions);
  const double limit = error_limit_of(style, incisions);
  const bool is_ring = incisions.front().incision.is_closed;
  std::vector<std::vector<PlacedError>> curves;
  double longest = is_ring ? 360.0 : 0.0;
  for (const ReportIncision& incision : incisions) {
    curves.push_back(is_ring ? by_angle(incision, style.approach) : by_arc(incision));
    if (!is_ring) longest = std::max(longest, curves.back().back().first);
  }
  const PlotArea area{
      .corner = {70.0, 44.0}, .size = {670.0, 250.0}, .x_high = longest, .y_low = -limit, .y_high = limit};
  SvgWriter svg(760.0, 350.0, "Signed error along the incision",
                "The error of each point of the incision contour; positive is farther from the tumour than intended.");
  draw_series_legend(svg, incisions, {70.0, 22.0});
  draw_zones(svg, area, incisions.front());
  draw_y_axis(svg, area, round_ticks(-limit, limit, 8), "signed error, mm");
  svg.line(area.at(0.0, 0.0), area.at(longest, 0.0), "stroke=\"#555\" stroke-width=\"1.2\"");
  std::vector<double> ticks;
  if (is_ring) {
    for (int k = 0; k <= 8; ++k) ticks.push_back(45.0 * k);
  } else {
    ticks = round_ticks(0.0, longest, 8);
  }
  draw_x_axis(
      svg, area, ticks,
      is_ring ? "angle around the tumour, counter-clockwise from the start of the path" : "length along the cut, mm",
      is_ring ? "°" : "");
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::vector<Vec2> line;
    for (const auto& [place, error] : curves[k]) line.push_back(area.at(place, error));
    svg.polyline(line, false,
                 fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}",
                             ink::of_series(k), k == 0 ? " stroke-dasharray=\"5 3\"" : ""));
  }
  draw_zone_names(svg, area, incisions.front());
  return svg.finish();
}

BoxNumbers box_numbers(std::span<const double> values) {
  INCISE_REQUIRE(!values.empty(), "expected at least one value");
  std::vector<double> sorted(values.begin(), values.end());
  BoxNumbers box;
  for (const double value : sorted) {
    INCISE_REQUIRE(std::isfinite(value), "expected finite values");
    box.mean += value / static_cast<double>(sorted.size());
  }
  std::sort(sorted.begin(), sorted.end());
  box.lower_quartile = quantile(sorted, 0.25);
  box.median = quantile(sorted, 0.5);
  box.upper_quartile = quantile(sorted, 0.75);
  const double reach = 1.5 * (box.upper_quartile - box.lower_quartile);
  box.low_whisker = box.lower_quartile;
  box.high_whisker = box.upper_quartile;
  for (const double value : sorted) {
    if (value < box.lower_quartile - reach || value > box.upper_quartile + reach) {
      box.outliers.push_back(value);
    } else {
      box.low_whisker = std::min(box.low_whisker, value);
      box.high_whisker = std::max(box.high_whisker, value);
    }
  }
  return box;
}

std::string box_plot_svg(std::span<const ReportIncision> incisions, const FigureStyle& style) {
  require_incisions(incisions);
  const double limit = error_limit_of(style, incisions);
  const double panel = 70.0 + 90.0 * static_cast<double>(incisions.size());
  const double width = 80.0 + 2.0 * panel + 80.0;
  SvgWriter svg(width, 350.0, "Distribution of the error",
                "Box plots of the signed and of the absolute error; line: median, diamond: mean, box: quartiles.");
  for (int side = 0; side < 2; ++side) {
    const bool is_signed = side == 0;
    const PlotArea area{.corner = {70.0 + side * (panel + 80.0), 44.0},
                        .size = {panel, 250.0},
                        .y_low = is_signed ? -limit : 0.0,
                        .y_high = limit};
    if (is_signed) draw_zones(svg, area, incisions.front());
    draw_y_axis(svg, area, round_ticks(area.y_low, area.y_high, 8), is_signed ? "signed error, mm" : "|error|, mm");
    draw_x_axis(svg, area, {}, "");
    for (std::size_t k = 0; k < incisions.size(); ++k) {
      const double center =
          area.corner.x() + area.size.x() * (static_cast<double>(k) + 0.5) / static_cast<double>(incisions.size());
      draw_error_box(svg, area, center, incisions[k].signed_error_mm, is_signed, ink::of_series(k));
      svg.text({center, 314.0}, incisions[k].name, "middle");
    }
    if (is_signed) draw_zone_names(svg, area, incisions.front());
  }
  svg.text({width / 2.0, 340.0}, "line: median · diamond: mean · box: quartiles · whiskers: 1.5 interquartile ranges",
           "middle", "font-size=\"12\" fill=\"#555\"");
  return svg.finish();
}

std::string histogram_svg(const ReportHistogram& histogram) {
  INCISE_REQUIRE(!histogram.counts.empty(), "expected at least one bin");
  INCISE_REQUIRE(std::isfinite(histogram.low) && std::isfinite(histogram.high) && histogram.high > histogram.low,
                 "expected a range of positive length");
  double highest = 0.0;
  for (const double count : histogram.counts) {
    INCISE_REQUIRE(std::isfinite(count) && count >= 0.0, "expected finite counts that are not negative");
    highest = std::max(highest, count);
  }
  const PlotArea area{.corner = {84.0, 20.0},
                      .size = {450.0, 210.0},
                      .x_low = histogram.low,
                      .x_high = histogram.high,
                      .y_high = highest > 0.0 ? 1.05 * highest : 1.0};
  SvgWriter svg(560.0, 290.0, "Histogram of the " + histogram.quantity,
                fmt::format("{} bins from {} to {} {}", histogram.counts.size(), number_text(histogram.low),
                            number_text(histogram.high), histogram.unit));
  draw_y_axis(svg, area, round_ticks(0.0, area.y_high, 5), "");
  svg.text({20.0, 125.0}, "count", "middle", "transform=\"rotate(-90 20 125)\"");
  const double bin = (histogram.high - histogram.low) / static_cast<double>(histogram.counts.size());
  for (std::size_t k = 0; k < histogram.counts.size(); ++k) {
    if (histogram.counts[k] == 0.0) continue;
    const double left = area.x(histogram.low + bin * static_cast<double>(k));
    const double right = area.x(histogram.low + bin * static_cast<double>(k + 1));
    const double top = area.y(histogram.counts[k]);
    svg.rectangle({left + 0.5, top}, {std::max(0.5, right - left - 1.0), area.y(0.0) - top}, "fill=\"#5b7f95\"");
  }
  const bool is_half_turn = histogram.low == 0.0 && histogram.high == 180.0;
  const std::vector<double> ticks =
      is_half_turn ? std::vector<double>{0, 30, 60, 90, 120, 150, 180} : round_ticks(histogram.low, histogram.high, 7);
  draw_x_axis(svg, area, ticks,
              fmt::format("{}{}{}", histogram.quantity, histogram.unit.empty() ? "" : ", ", histogram.unit));
  return svg.finish();
}

}  // namespace incise
