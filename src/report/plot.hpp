#pragma once

#include "report/svg.hpp"

#include <incise/report/figures.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Round numbers (1, 2 or 5 times a power of ten apart) within [low, high], at most about `count`.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int count);

/// The smallest of 1, 2, 5 times a power of ten that is >= value. @pre value > 0.
[[nodiscard]] double rounded_up(double value);

/// Colour, components in [0, 1], of an error as a share, in [-1, 1], of the limit: -1 = closer, 0 = as intended, 1 =
/// farther.
[[nodiscard]] Vec3 error_color(double share, ErrorColors colors);

/// A rectangle of a figure that shows a range of x and of y.
struct PlotArea {
  Vec2 corner = Vec2::Zero();  ///< top left, px
  Vec2 size = Vec2::Ones();    ///< px
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  [[nodiscard]] double x(double value) const { return corner.x() + size.x() * (value - x_low) / (x_high - x_low); }
  [[nodiscard]] double y(double value) const {
    return corner.y() + size.y() * (1.0 - (value - y_low) / (y_high - y_low));
  }
  [[nodiscard]] Vec2 at(double x_value, double y_value) const { return {x(x_value), y(y_value)}; }
};

/// Horizontal rules and numbers at `ticks`, and the axis' name turned by 90 degrees.
void draw_y_axis(SvgWriter& svg, const PlotArea& area, const std::vector<double>& ticks, std::string_view name);
/// Small marks and numbers at `ticks`, the axis line, and the axis' name below.
void draw_x_axis(SvgWriter& svg, const PlotArea& area, const std::vector<double>& ticks, std::string_view name,
                 std::string_view tick_suffix = "");

/// Returns where each entry of a legend begins, px: beside the entry before, or at the left of a new row if it would
/// pass the right edge. @param widths  of the entries, px. @param first  start of the first entry. @param right  edge
/// of the rows. @param first_right  edge of the first row, which may have something else at its end.
[[nodiscard]] std::vector<Vec2> legend_places(std::span<const double> widths, const Vec2& first, double right,
                                              double first_right);
inline constexpr double kLegendRow = 18.0;  ///< from one row to the next, px

/// Colours that have one meaning in the whole report.
namespace ink {
inline constexpr std::string_view kTumorEdge = "#009e73";
inline constexpr std::string_view kIntended = "#111111";
inline constexpr std::string_view kCorrected = "#0072b2";
inline constexpr std::string_view kKerf = "#e69f00";
inline constexpr std::string_view kTooClose = "#cc79a7";
inline constexpr std::string_view kTooCloseText = "#8f3f70";  // a darker shade, for text
inline constexpr std::string_view kReached = "#b3123f";
inline constexpr std::array<std::string_view, 4> kSeries{"#6b6b6b", "#0072b2", "#d55e00", "#009e73"};
/// Returns the colour of series k; the colours repeat.
[[nodiscard]] constexpr std::string_view of_series(std::size_t k) {
  return kSeries[k % kSeries.size()];
}
}  // namespace ink

/// Throws InvalidArgument unless the incision has a contour, one finite error per point, and finite contours.
void require_drawable(const ReportIncision& incision);

/// Returns the limit of `style`, or the limit that the incisions need if that is greater, mm.
[[nodiscard]] double error_limit_of(const FigureStyle& style, std::span<const ReportIncision> incisions);

}  // namespace incise
