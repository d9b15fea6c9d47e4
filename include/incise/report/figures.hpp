#pragma once

#include <incise/core/names.hpp>
#include <incise/report/report_data.hpp>

#include <span>
#include <string>

namespace incise {

/// Colour scale of the error.
enum class ErrorColors {
  Safe,  ///< blue - grey - rust: can be distinguished with any colour vision
  Jet,   ///< blue - cyan - yellow - red, as in the paper's Fig. 6
};
inline constexpr std::array<std::string_view, 2> kErrorColorsNames{"safe", "jet"};
[[nodiscard]] constexpr Names names_of(ErrorColors) {
  return kErrorColorsNames;
}

/// Settings that the figures of one report share.
struct FigureStyle {
  ErrorColors colors = ErrorColors::Safe;
  double error_limit_mm =
      0.0;  ///< error axis and colour bar extend at least this far both ways, >= 0; farther if the data do
  Vec3 approach = -Vec3::UnitZ();  ///< direction of view
  std::array<std::string, 6> axis_names{"R", "L", "A", "P", "I", "S"};  ///< ends of the axes: -x, +x, -y, +y, -z, +z
  Points shown_mm;  ///< a contour figure leaves room for these points, too, so that figures side by side have one scale
};

/// Returns a style that gives the contour figures of several incisions the same colour range and scale.
[[nodiscard]] FigureStyle common_style(std::span<const ReportIncision> incisions, const Vec3& approach,
                                       const std::array<std::string, 6>& axis_names);

/// Returns the error limit that covers all points of all incisions, rounded up to a multiple of 0.5 mm; at least
/// 0.5 mm.
[[nodiscard]] double common_error_limit_mm(std::span<const ReportIncision> incisions);

/// Draws an incision as seen along the approach: tumour edge (green), intended path (black), corrected path (blue), the
/// incision coloured by its signed error with a colour bar, a scale bar of 5 mm, and marks where the cut came too close
/// to the tumour edge or reached it. 400 px wide, to be readable on a phone or beside another figure. All figures of
/// this header are complete SVG documents without external references.
/// @throws InvalidArgument for a number that is not finite, for an incision contour of fewer than two points, or unless
/// every point of it has an error. Source: after [Paper, Fig. 6].
[[nodiscard]] std::string contour_figure_svg(const ReportIncision& incision, const FigureStyle& style = {});

/// Draws the signed error around the ring, against the angle about the tumour's centre, counter-clockwise from the
/// start of the path. For an open cut it is drawn against the arc length. Bands mark "too close" and "tumour edge
/// reached"; the first incision sets them. @throws as contour_figure_svg; also without incisions.
[[nodiscard]] std::string error_by_angle_svg(std::span<const ReportIncision> incisions, const FigureStyle& style = {});

/// Draws box plots of the signed and of the absolute error of each incision: median, quartiles (linear interpolation),
/// whiskers to the last point within 1.5 interquartile ranges of the box, the points beyond, and the mean.
/// @throws as error_by_angle_svg.
[[nodiscard]] std::string box_plot_svg(std::span<const ReportIncision> incisions, const FigureStyle& style = {});

/// Draws a histogram. @throws InvalidArgument without bins, for a count that is negative or not finite, or unless low <
/// high.
[[nodiscard]] std::string histogram_svg(const ReportHistogram& histogram);

/// The numbers behind one box of box_plot_svg.
struct BoxNumbers {
  double low_whisker = 0.0, lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0, high_whisker = 0.0, mean = 0.0;
  std::vector<double> outliers;  ///< ascending
};
/// @throws InvalidArgument without values, or for one that is not finite.
[[nodiscard]] BoxNumbers box_numbers(std::span<const double> values);

}  // namespace incise
