#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// The errors of one incision in a comparison.
struct ErrorSeries {
  std::string name;
  bool is_after = false;
  std::vector<double> signed_error_mm;  ///< at least one, finite
  std::vector<double> clock_h;          ///< one for each error, [0, 12); empty: an open cut
};

/// Upper borders, in signed error, of the zones of the paper's Fig. 6.
struct ZoneBorders {
  double positive_mm = -4.5;   ///< at or below: the tumour edge is reached
  double too_close_mm = -2.3;  ///< at or below, and above the other: too little tissue
};

/// Box plots of absolute (a) and signed (b) errors, all points before and after and then each incision, with the failed
/// and too-close zones; in (a) the zones hold for errors towards the tumour only, which the label says.
/// @param zones  absent: none is drawn, where incisions differ in their target and so in their zones.
/// @throws InvalidArgument without series or for a number that is not finite. Source: after [Paper, Fig. 6 a, b].
[[nodiscard]] std::string comparison_box_plot_svg(std::span<const ErrorSeries> series,
                                                  const std::optional<ZoneBorders>& zones = ZoneBorders{});

/// Signed error against the place on a clock face over the tumour, 12 o'clock at both ends, with the same zones. Before
/// is dashed. @throws as above; also if a series has no clock positions.
[[nodiscard]] std::string error_by_clock_svg(std::span<const ErrorSeries> series,
                                             const std::optional<ZoneBorders>& zones = ZoneBorders{});

}  // namespace incise
