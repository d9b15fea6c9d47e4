#pragma once

#include <incise/evaluation/block_bootstrap.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// A forecast of an event, and whether the event happened.
struct Forecast {
  double said = 0.0;  ///< the event's probability or, for a RocCurve, any score that rises with it
  bool happened = false;
  std::size_t cluster = 0;  ///< forecasts of one cluster are correlated, as by a common calibration or laboratory
};

/// Rates of one threshold of the score, [0, 1].
struct RocPoint {
  double false_alarms = 0.0;  ///< share of the forecasts without the event at or above the threshold
  double caught = 0.0;        ///< share of the forecasts with the event at or above the threshold
};

/// How well a score separates the forecasts whose event happened from the others, over all thresholds.
struct RocCurve {
  std::size_t happened = 0;  ///< number of forecasts whose event happened
  std::size_t did_not = 0;   ///< number of the others
  double area = 0.0;         ///< P(score with the event > score without) + half of P(equal); in [0, 1]
  /// Bootstrap percentiles of the area. With one cluster, both kinds of forecasts are redrawn separately; with several,
  /// whole clusters are redrawn, and draws that lack one kind are discarded. 0 to 1 if too few draws remain.
  Interval confidence;
  std::vector<RocPoint> points;  ///< (0, 0), then one for each distinct score, up to (1, 1); both ascending
};

/// Computes the receiver operating characteristic and its area [HanleyMcNeil1982]. With a single cluster, each forecast
/// counts as one specimen, so several forecasts of one specimen would make the interval too narrow. O(replicates · n
/// log n).
/// @throws InvalidArgument if one of the two kinds is missing, for a score that is not finite, or for settings out of
/// range.
[[nodiscard]] RocCurve roc_curve(std::span<const Forecast> forecasts, const BootstrapSettings& settings = {});

/// Returns whether the second of two cuts of one specimen is the worse one; nothing for two open rings, which cannot be
/// compared.
/// @param first_mm, second_mm  mean absolute error, mm; absent for an open ring, which is worse than any closed one.
[[nodiscard]] std::optional<bool> is_second_worse(const std::optional<double>& first_mm,
                                                  const std::optional<double>& second_mm);

/// Forecasts of about the same probability, and how often their event happened.
struct ReliabilityBin {
  std::size_t forecasts = 0;  ///< >= 1
  std::size_t happened = 0;
  double mean_said = 0.0;  ///< mean of the forecast probabilities
  double share = 0.0;      ///< happened / forecasts
  /// 95 % interval of the share: Wilson's score interval [Wilson1927]. For several clusters, the number of forecasts is
  /// first divided by the design effect (at least 1) [RaoScott1992].
  Interval confidence;
};

struct Reliability {
  std::vector<ReliabilityBin> bins;  ///< those with a forecast, ascending
  double brier_score = 0.0;          ///< mean of (probability − event)², event 0 or 1: 0 best, 0.25 if always 0.5
};

/// Compares predicted probabilities with observed frequencies, in `bins` equal parts of [0, 1] [Brier1950]. If none or
/// all of the events of a bin happened, its design effect is unknown, and the interval treats its forecasts as
/// independent.
/// @throws InvalidArgument without forecasts, for a probability outside [0, 1], or bins < 1.
[[nodiscard]] Reliability reliability(std::span<const Forecast> forecasts, std::size_t bins = 5);

}  // namespace incise
