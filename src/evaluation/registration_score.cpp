#include <incise/core/error.hpp>
#include <incise/evaluation/registration_score.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kMeanWeight = 0.75;
constexpr double kMaxWeight = 0.25;

}  // namespace

double registration_score_mm(double mean_abs_error_mm, double max_abs_error_mm) {
  INCISE_REQUIRE(mean_abs_error_mm >= 0.0 && mean_abs_error_mm <= max_abs_error_mm && std::isfinite(max_abs_error_mm),
                 fmt::format("found a mean of {} and a greatest error of {} mm, expected 0 <= mean <= greatest",
                             mean_abs_error_mm, max_abs_error_mm));
  return kMeanWeight * mean_abs_error_mm + kMaxWeight * max_abs_error_mm;
}

double registration_percent(const std::optional<double>& score_mm, double baseline_mm) {
  INCISE_REQUIRE(baseline_mm > 0.0 && std::isfinite(baseline_mm),
                 fmt::format("found a baseline of {} mm, expected more than 0", baseline_mm));
  return score_mm ? 100.0 * *score_mm / baseline_mm : 0.0;
}

BaselineRange baseline_range(const PrintedScore& row) {
  INCISE_REQUIRE(row.percent.value > row.percent.half_unit,
                 fmt::format("found {} %, expected more than its rounding", row.percent.value));
  const auto score = [&](double side) {
    return kMeanWeight * (row.mean_mm.value + side * row.mean_mm.half_unit) +
           kMaxWeight * (row.max_mm.value + side * row.max_mm.half_unit);
  };
  return {100.0 * score(-1.0) / (row.percent.value + row.percent.half_unit),
          100.0 * score(1.0) / (row.percent.value - row.percent.half_unit)};
}

}  // namespace incise
