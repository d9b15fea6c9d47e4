#pragma once

#include <incise/evaluation/block_bootstrap.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// What was said of something that might happen, and whether it did.
struct Forecast {
  double said = 0.0;  ///< a probability, or (for a RocCurve) any score that is higher where it is likelier
  bool happened = false;
  std::size_t cluster = 0;  ///< those of one number have something in common: a calibration, a laboratory
};

/// A threshold's share of false alarms and of events that it catches.
struct RocPoint {
  double false_alarms = 0.0;
  double caught = 0.0;
};

/// How well a score tells what happened from what did not, whatever the threshold.
struct RocCurve {
  std::size_t happened = 0;  ///< forecasts of something that happened …
  std::size_t did_not = 0;   ///< … and that did not
  double area = 0.0;         ///< P(a score of the first kind is above one of the second) + half of P(equal); in [0, 1]
  /// Of the area, percentiles of a bootstrap that draws both kinds anew, each by itself; of forecasts in clusters: that
  /// draws whole clusters anew, as often as both kinds are among them; 0 to 1 where that is hardly ever so.
  Interval confidence;
  std::vector<RocPoint> points;  ///< from (0, 0) to (1, 1), both ascending, one for each score that was found
};

/// Receiver operating characteristic and its area [HanleyMcNeil1982]. A single forecast counts as one specimen: scores
/// of one specimen twice would make the interval too narrow. O(replicates · n log n).
/// @throws InvalidArgument without one of both kinds, for a score that is not finite, or for settings out of range.
[[nodiscard]] RocCurve roc_curve(std::span<const Forecast> forecasts, const BootstrapSettings& settings = {});

/// Whether the second of two cuts of one specimen is the worse one, by mean absolute error in mm; absent: an open ring,
/// which is worse than any closed one. @returns nothing for two open rings: they tell nothing.
[[nodiscard]] std::optional<bool> is_second_worse(const std::optional<double>& first_mm,
                                                  const std::optional<double>& second_mm);

/// Forecasts of about the same probability, and how often it happened.
struct ReliabilityBin {
  std::size_t forecasts = 0;  ///< >= 1
  std::size_t happened = 0;
  double mean_said = 0.0;
  double share = 0.0;   ///< that happened
  /// Of the share, 95 %, Wilson's score interval [Wilson1927]; of forecasts in clusters: of as many as are worth these
  /// (their number over the design effect, where that is above 1) [RaoScott1992].
  Interval confidence;
};

struct Reliability {
  std::vector<ReliabilityBin> bins;  ///< ascending, those that hold a forecast
  double brier_score = 0.0;          ///< mean squared difference of probability and event: 0 best, 0.25 for "a half"
};

/// Predicted against observed: [0, 1] in `bins` equal parts. [Brier1950] A share of none or of all tells nothing of a
/// design effect: its interval takes the forecasts as independent.
/// @throws InvalidArgument without forecasts, for a probability outside [0, 1], or bins < 1.
[[nodiscard]] Reliability reliability(std::span<const Forecast> forecasts, std::size_t bins = 5);

}  // namespace incise
