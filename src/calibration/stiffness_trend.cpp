#include <incise/calibration/stiffness_trend.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {

double StiffnessTrend::shift_mm(double youngs_modulus_kpa) const {
  return slope_mm * (1.0 - reference_kpa / youngs_modulus_kpa);
}

double StiffnessTrend::shift_sd_mm(double youngs_modulus_kpa) const {
  return slope_sd_mm * std::abs(1.0 - reference_kpa / youngs_modulus_kpa);
}

double StiffnessTrend::rise_sd_mm(double youngs_modulus_kpa) const {
  return slope_sd_mm * reference_kpa / youngs_modulus_kpa;
}

StiffnessTrend stiffness_trend(std::span<const StiffnessReading> readings, double reading_sd_mm) {
  INCISE_REQUIRE(!readings.empty() && reading_sd_mm > 0.0,
                 fmt::format("expected readings, and an sd above 0, found {} and {}", readings.size(), reading_sd_mm));
  StiffnessTrend trend;
  double mean_difference = 0.0;
  double mean_compliance = 0.0;  // 1/kPa
  const auto count = static_cast<double>(readings.size());
  for (const StiffnessReading& reading : readings) {
    INCISE_REQUIRE(std::isfinite(reading.youngs_modulus_kpa) && reading.youngs_modulus_kpa > 0.0 &&
                       std::isfinite(reading.difference_mm),
                   fmt::format("expected a modulus above 0 and a finite difference, found {} kPa and {} mm",
                               reading.youngs_modulus_kpa, reading.difference_mm));
    mean_compliance += 1.0 / (reading.youngs_modulus_kpa * count);
    mean_difference += reading.difference_mm / count;
  }
  trend.reference_kpa = 1.0 / mean_compliance;
  double across = 0.0;
  double along = 0.0;
  for (const StiffnessReading& reading : readings) {
    const double off = 1.0 - trend.reference_kpa / reading.youngs_modulus_kpa;
    along += off * off;
    across += off * (reading.difference_mm - mean_difference);
  }
  const double variance = reading_sd_mm * reading_sd_mm;
  const double precision = along / variance + 1.0 / (kTrendPriorMm * kTrendPriorMm);
  trend.slope_mm = across / variance / precision;
  trend.slope_sd_mm = 1.0 / std::sqrt(precision);
  return trend;
}

}  // namespace incise
