#pragma once

#include <incise/core/names.hpp>
#include <incise/report/report_data.hpp>

#include <span>
#include <string>

namespace incise {

/// How an error in mm becomes a colour.
enum class ErrorColors {
  Safe,  ///< blue - grey - rust: can be distinguished with any colour vision
  Jet,   ///< blue - cyan - yellow - red, as in the paper's Fig. 6
};
inline constexpr std::array<std::string_view, 2> kErrorColorsNames{"safe", "jet"};
[[nodiscard]] constexpr Names names_of(ErrorColors) {
  return kErrorColorsNames;
}

/// What figures of one report share.
struct FigureStyle {
  ErrorColors colors = ErrorColors::Safe;
  double error_limit_mm =
      0.0;  ///< error axis and colour bar reach at least this far both ways; farther where the data do
  Vec3 approach = -Vec3::UnitZ();
  std::array<std::string, 6> axis_names{"R", "L", "A", "P", "I", "S"};
  Points shown_mm;  ///< a contour figure has room for these, too: figures side by side then have one scale
};

/// What the contour figures of several incisions share: one range of colours, one scale.
[[nodiscard]] FigureStyle common_style(std::span<const ReportIncision> incisions, const Vec3& approach,
                                       const std::array<std::string, 6>& axis_names);

/// The error limit that covers all points of all incisions, rounded up to a round number, mm (0.5 at least).
[[nodiscard]] double common_error_limit_mm(std::span<const ReportIncision> incisions);

/// Seen along the approach: tumour edge (green), intended path (black), corrected path (blue), the incision coloured by
/// its signed error with a colour bar, a scale bar of 5 mm, and marks where the cut came too close to or reached the
/// tumour edge. 400 px wide, to be read on a phone or beside another. All figures are complete SVG documents without a
/// reference to anything outside. @throws InvalidArgument if a number is not finite, or there is no incision contour or
/// not one error per point of it. Source: after [Paper, Fig. 6].
[[nodiscard]] std::string contour_figure_svg(const ReportIncision& incision, const FigureStyle& style = {});

/// Signed error against the place on the ring: the angle about the tumour's centre, counter-clockwise from the start of
/// the path (against the arc length for an open cut), with the bands "too close" and "tumour edge reached". @throws as
/// contour_figure_svg.
[[nodiscard]] std::string error_by_angle_svg(std::span<const ReportIncision> incisions, const FigureStyle& style = {});

/// Box plots of the signed and of the absolute error of each incision: median, quartiles (linear interpolation),
/// whiskers to the last point within 1.5 interquartile ranges, the points beyond, and the mean. @throws as
/// contour_figure_svg.
[[nodiscard]] std::string box_plot_svg(std::span<const ReportIncision> incisions, const FigureStyle& style = {});

/// @throws InvalidArgument without bins, or when a count is negative or not finite.
[[nodiscard]] std::string histogram_svg(const ReportHistogram& histogram);

/// The numbers behind one box of box_plot_svg.
struct BoxNumbers {
  double low_whisker = 0.0, lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0, high_whisker = 0.0, mean = 0.0;
  std::vector<double> outliers;  ///< ascending
};
/// @pre at least one value, all finite.
[[nodiscard]] BoxNumbers box_numbers(std::span<const double> values);

}  // namespace incise
