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
  std::vector<double> clock_h;          ///< one per error, [0, 12); empty: an open cut
};

/// Upper borders, in signed error, of the zones of the paper's Fig. 6.
struct ZoneBorders {
  double positive_mm = -4.5;   ///< at or below: the tumour edge is reached
  double too_close_mm = -2.3;  ///< at or below this, and above positive_mm: too little tissue is left
};

/// Draws box plots of the absolute (a) and signed (b) errors: all points before, all points after, then each incision.
/// Shaded zones mark where the tumour edge is reached and where too little tissue is left; in (a) they apply only to
/// errors towards the tumour, and the key says so.
/// @param zones  absent: no zones are drawn, as for incisions with different targets.
/// @returns a complete SVG document. @throws InvalidArgument without series, for a series without errors, or for a
/// number that is not finite. Source: after [Paper, Fig. 6 a, b].
[[nodiscard]] std::string comparison_box_plot_svg(std::span<const ErrorSeries> series,
                                                  const std::optional<ZoneBorders>& zones = ZoneBorders{});

/// Draws the signed error against the clock position, with 12 o'clock at both ends and the same zones. Curves before
/// the change are dashed.
/// @throws as comparison_box_plot_svg; also unless every error has a clock position in [0, 12).
[[nodiscard]] std::string error_by_clock_svg(std::span<const ErrorSeries> series,
                                             const std::optional<ZoneBorders>& zones = ZoneBorders{});

}  // namespace incise
