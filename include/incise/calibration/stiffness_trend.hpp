#pragma once

#include <span>

namespace incise {

/// What one calibrated specimen says of the next one's bias.
struct StiffnessReading {
  double youngs_modulus_kpa = 0.0;  ///< by its pull, > 0
  double difference_mm = 0.0;       ///< mean along its ring of photographed less fitted signed error
};

/// How the bias changes with stiffness beyond what the simulation says of it. The simulated tool holds tissue for a
/// length, whatever the tissue's stiffness; a real electrode holds it with a force, and what tissue yields to a force
/// is its compliance times that force. So the bias is a straight line in the compliance: rigid tissue does not yield at
/// all, and there the bias comes to an end; in soft tissue it grows without one.
struct StiffnessTrend {
  double reference_kpa = 1.0;  ///< harmonic mean of the calibrated moduli, where the bias is the calibration's own
  double slope_mm = 0.0;       ///< what the bias gains from there to rigid tissue
  double slope_sd_mm = 0.0;    ///< how uncertain that is
  /// Expected change of the bias at a stiffness, slope · (1 − reference / modulus), mm.
  [[nodiscard]] double shift_mm(double youngs_modulus_kpa) const;
  /// Its standard deviation, mm: 0 where the calibration was; at most that of the slope on the stiff side.
  [[nodiscard]] double shift_sd_mm(double youngs_modulus_kpa) const;
  /// Standard deviation of what the bias gains per unit of ln stiffness, mm.
  [[nodiscard]] double rise_sd_mm(double youngs_modulus_kpa) const;
};

/// A straight line through what is left of the calibrated specimens, against their compliance; its slope is normal
/// about 0 with kTrendPriorMm before they are looked at, so that few specimens, or alike ones, leave it nearly that
/// uncertain.
/// @param reading_sd_mm  of one specimen's difference: from specimen to specimen, and what one ring leaves, > 0.
/// @throws InvalidArgument without readings, for a modulus that is not above 0, or a difference that is not finite.
[[nodiscard]] StiffnessTrend stiffness_trend(std::span<const StiffnessReading> readings, double reading_sd_mm);

/// Prior standard deviation of the slope, mm: half of what a cut errs as planned, which is what rigid tissue could at
/// most spare it. Chosen.
inline constexpr double kTrendPriorMm = 0.7;

}  // namespace incise
