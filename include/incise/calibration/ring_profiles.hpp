#pragma once

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/describe.hpp>

#include <vector>

namespace incise {

/// Mean signed errors of the photographed specimens: the forecast of the next cut from photographs alone. Sectors are
/// those of error_profile.
struct PhotographedProfile {
  double constant_mm = 0.0;         ///< mean over all sectors
  std::vector<double> mean_mm;      ///< by sector
  std::vector<double> smoothed_mm;  ///< mean_mm in waves of at most four per turn
};
inline void describe(Visitor& v, PhotographedProfile& p) {
  v({"constant_mm", "Mean signed error of all photographs.", "mm"}, p.constant_mm);
  v({"mean_mm", "The same by sector: a list for compensation.photographed_mm.", "mm"}, p.mean_mm);
  v({"smoothed_mm", "mean_mm, reduced to waves of at most four per turn.", "mm"}, p.smoothed_mm);
}

/// What photographs show beyond the simulation and its bias. A real cut along the planned path is expected to err by
/// simulated_share · (simulated error + bias) + mean_mm, sector by sector.
struct ResidualProfile {
  double simulated_share = 1.0;     ///< photographed difference between specimens per simulated difference
  double simulated_share_sd = 0.0;  ///< standard deviation of that estimate
  std::vector<double> mean_mm;      ///< by sector
  double sd_mm = 0.0;               ///< standard deviation of the estimated common residual, the same in every sector
  double amplitude_mm = 0.0;        ///< standard deviation of the common residual along the ring, estimated
  double correlation_deg = 0.0;     ///< angle over which its correlation falls to 1/e, estimated
};
inline void describe(Visitor& v, ResidualProfile& p) {
  v("simulated_share", p.simulated_share,
    "Photographed difference between specimens per simulated difference: for compensation.simulated_share.");
  v("simulated_share_sd", p.simulated_share_sd, "Standard deviation of that estimate.");
  v({"mean_mm", "Expected beyond that share of simulated error and bias: a list for compensation.residual_mm.", "mm"},
    p.mean_mm);
  v({"sd_mm", "Standard deviation with which the common residual of the specimens is known, the same in every sector.",
     "mm"},
    p.sd_mm);
  v({"amplitude_mm", "Standard deviation of that residual along the ring.", "mm"}, p.amplitude_mm);
  v({"correlation_deg", "Angle over which its correlation falls to 1/e.", "deg"}, p.correlation_deg);
}

/// Returns the mean photographed profile of the specimens.
/// @throws InvalidArgument without specimens, or if their numbers of sectors differ.
[[nodiscard]] PhotographedProfile photographed_profile(const std::vector<SpecimenFit>& specimens);

/// Estimates what photographs show beyond the simulation. The model, with y_s the photographed and m_s the fitted
/// errors of specimen s, and m the mean of m_s over specimens:
///     y_s(θ) = m(θ) + β (m_s(θ) − m(θ)) + f(θ) + g_s(θ),    β ~ N(1, 0.5²),  f ~ GP(0, a² exp(−angle/ρ)),
/// with g_s independent from specimen to specimen. In the spectrum of the ring every covariance is diagonal. The fit's
/// ResidualEstimate, which attributes the whole residual to the specimen, gives the variance T of f and g_s together:
/// with A the variance of f, each wave of g_s has B = T − A, but at least the reading's variance. The differences
/// between specimens determine β, by weighted least squares, and B. Their common part determines f: each wave of the
/// specimens' mean residual is shrunk by A/(A + B/n). a and ρ are integrated over on a grid. Then mean_mm = f + (1 − β)
/// m. Without photographs the result would be the simulation (β = 1, f = 0); if simulated differences say nothing of
/// photographed ones, and specimens are many, it approaches the photographs' mean.
/// Source: [RasmussenWilliams2006, 2.2, 2.7 and 5.4.1]. @note O(specimens · sectors² + grid · sectors).
/// @throws InvalidArgument as photographed_profile, or for a fit without a residual.
[[nodiscard]] ResidualProfile residual_profile(const DragFit& fit);

}  // namespace incise
