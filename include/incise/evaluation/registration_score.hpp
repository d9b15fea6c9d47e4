#pragma once

#include <optional>

namespace incise {

/// Returns the paper's registration score of a simulated incision, mm: 0.75 mean |e| + 0.25 max |e|. Source: [Paper,
/// III-A.2]. @pre 0 <= mean <= max, finite (InvalidArgument).
[[nodiscard]] double registration_score_mm(double mean_abs_error_mm, double max_abs_error_mm);

/// Returns a registration score in per cent of the baseline, the score of the real incisions. An incision that failed
/// (absent) has 0 %. The result is not a distance: 100 is best, 90 and 110 are equally far off, and an incision with
/// the same mean and greatest error elsewhere also has 100.
/// @pre baseline_mm > 0, finite (InvalidArgument).
[[nodiscard]] double registration_percent(const std::optional<double>& score_mm, double baseline_mm);

/// A printed number and half a unit of its last digit: the true number lies in value ± half_unit.
struct PrintedNumber {
  double value = 0.0;
  double half_unit = 0.0;
};

/// One printed row: mean and greatest error, mm, and the per cent computed from them.
struct PrintedScore {
  PrintedNumber mean_mm;
  PrintedNumber max_mm;
  PrintedNumber percent;
};

/// Range of baselines, mm, with which a row's per cent follows from its mean and max, all within rounding.
struct BaselineRange {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// Returns the baselines that explain a printed row. @pre percent above its half unit (InvalidArgument).
[[nodiscard]] BaselineRange baseline_range(const PrintedScore& row);

}  // namespace incise
