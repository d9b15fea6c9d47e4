#pragma once

#include <span>

namespace incise {

/// What one calibrated specimen says of the next one's bias.
struct StiffnessReading {
  double youngs_modulus_kpa = 0.0;  ///< by its pull, > 0
  double difference_mm = 0.0;       ///< mean along its ring of photographed less fitted signed error
};

/// How the bias changes with stiffness beyond what the simulation says of it: the simulated tool holds tissue for a
/// length, whatever the tissue's stiffness, where a real electrode holds it with a force.
struct StiffnessTrend {
  double mean_ln_kpa = 0.0;  ///< of the calibrated specimens, where the bias is the calibration's own
  double slope_mm = 0.0;     ///< of the bias, per unit of ln stiffness
  double slope_sd_mm = 0.0;  ///< how uncertain that is
  /// Expected change of the bias at a stiffness, mm.
  [[nodiscard]] double shift_mm(double youngs_modulus_kpa) const;
  /// Its standard deviation, mm: 0 where the calibration was, growing to both sides.
  [[nodiscard]] double shift_sd_mm(double youngs_modulus_kpa) const;
};

/// A straight line through what is left of the calibrated specimens, against ln stiffness; its slope is normal about 0
/// with kTrendPriorMm before they are looked at, so that few specimens, or alike ones, leave it nearly that uncertain.
/// @param reading_sd_mm  of one specimen's difference: from specimen to specimen, and what one ring leaves, > 0.
/// @throws InvalidArgument without readings, for a modulus that is not above 0, or a difference that is not finite.
[[nodiscard]] StiffnessTrend stiffness_trend(std::span<const StiffnessReading> readings, double reading_sd_mm);

/// Prior standard deviation of the slope, mm per unit of ln stiffness: about the error of a cut as planned, over the
/// factor of 8 or so by which soft tissues differ. Chosen.
inline constexpr double kTrendPriorMm = 0.7;

}  // namespace incise
