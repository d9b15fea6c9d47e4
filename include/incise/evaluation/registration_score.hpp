#pragma once

#include <optional>

namespace incise {

/// The paper's agreement of a simulated incision with a real one, mm: 0.75 mean |e| + 0.25 max |e|. Source: [Paper,
/// III-A.2]. @pre 0 <= mean <= max, finite.
[[nodiscard]] double registration_score_mm(double mean_abs_error_mm, double max_abs_error_mm);

/// As per cent of the score of the real incisions; an incision that failed (absent) scores 0 %. It is no distance: 100
/// is best, both 90 and 110 are ten off, and an incision with the same two numbers in other places scores 100, too.
/// @pre baseline_mm > 0.
[[nodiscard]] double registration_percent(const std::optional<double>& score_mm, double baseline_mm);

/// A number as it was printed, and half a unit of its last place: the true one lies in value ± half_unit.
struct PrintedNumber {
  double value = 0.0;
  double half_unit = 0.0;
};

/// One printed row: mean and greatest error, mm, and the per cent that was made of them.
struct PrintedScore {
  PrintedNumber mean_mm;
  PrintedNumber max_mm;
  PrintedNumber percent;
};

/// Baselines, mm, with which a row's per cent follows from its mean and max, all within rounding.
struct BaselineRange {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// @pre percent above its half unit.
[[nodiscard]] BaselineRange baseline_range(const PrintedScore& row);

}  // namespace incise
