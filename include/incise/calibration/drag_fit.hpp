#pragma once

#include <incise/calibration/calibration_run.hpp>
#include <incise/calibration/drag_response.hpp>
#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// One photographed cut, and the simulated response of its specimen.
struct FitSpecimen {
  std::string name;
  std::vector<double> signed_error_mm;  ///< photographed, by sector
  DragResponse response;                ///< simulated, with as many sectors
  double own_stiffness_sd = 0.0;        ///< sd of ln(Young's modulus) of this specimen about its reference, >= 0
};

/// The prior of a fit, and how its posterior is reported. The prior of the drag length is uniform over the range in
/// which all specimens were simulated.
struct DragFitSettings {
  double stiffness_sd = 0.5;
  double bias_sd_mm = 0.5;
  double reading_sd_mm = 0.1;
  double credible = 0.9;
  int samples = 64;
};
inline void describe(Visitor& v, DragFitSettings& s) {
  v("stiffness_sd", s.stiffness_sd,
    "Standard deviation of the ln(stiffness factor) common to all specimens; its mean is 0.", kPositive);
  v({"bias_sd_mm", "Standard deviation of the common bias; its mean is 0.", "mm"}, s.bias_sd_mm, kPositive);
  v({"reading_sd_mm",
     "Standard deviation of a sector's error from reading the photograph and from the mesh's grain; independent of the "
     "other sectors'.",
     "mm"},
    s.reading_sd_mm, kPositive);
  v("credible", s.credible, "Mass of the credible intervals.", {0.0, 1.0, true, true});
  v("samples", s.samples, "Number of samples of the posterior.", {1.0});
}

/// Posterior of one parameter.
struct ParameterEstimate {
  double mean = 0.0;
  double sd = 0.0;
  double low = 0.0;  ///< ends of the equal-tailed credible interval
  double high = 0.0;
  double prior_sd = 0.0;
  std::vector<double> grid;     ///< values at which the marginal density is given
  std::vector<double> density;  ///< integrates to 1
};
inline void describe(Visitor& v, ParameterEstimate& e) {
  v("mean", e.mean, "Mean of the posterior.");
  v("sd", e.sd, "Standard deviation of the posterior.");
  v("low", e.low, "Lower end of the equal-tailed credible interval.");
  v("high", e.high, "Upper end of that interval.");
  v("prior_sd", e.prior_sd, "Standard deviation of the prior.");
  v("grid", e.grid, "Values at which the marginal density is given.");
  v("density", e.density, "Marginal density at these values; it integrates to 1.");
}

/// Difference between photograph and simulation, estimated from the data. Standard deviations unless stated otherwise.
struct ResidualEstimate {
  double sd_mm = 0.0;               ///< of the part that is correlated along the contour
  double correlation_deg = 0.0;     ///< angle over which the correlation falls to 1/e
  double reading_mm = 0.0;          ///< independent from sector to sector: reading of the photograph, grain of the mesh
  double specimen_spread_mm = 0.0;  ///< of a specimen's bias about the common bias
  double placement_mm = 0.0;        ///< of the shift of a whole cut, along each axis of the picture
  double n_effective = 0.0;         ///< number of independent values that one contour is worth for its mean
};
inline void describe(Visitor& v, ResidualEstimate& r) {
  v({"sd_mm", "Standard deviation of the part that is correlated along the contour.", "mm"}, r.sd_mm, kAnatomyMm);
  v({"correlation_deg", "Angle over which that correlation falls to 1/e.", "deg"}, r.correlation_deg, {1e-6, 1e5});
  v({"reading_mm", "Standard deviation of the part that is independent from sector to sector.", "mm"}, r.reading_mm,
    kAnatomyMm);
  v({"specimen_spread_mm", "Standard deviation of the bias from specimen to specimen.", "mm"}, r.specimen_spread_mm,
    kAnatomyMm);
  v({"placement_mm", "Standard deviation of the shift of a whole cut, along each axis.", "mm"}, r.placement_mm,
    kAnatomyMm);
  v("n_effective", r.n_effective, "Number of independent values that one contour is worth.", {1e-6, 1e6});
}

struct PosteriorSample {
  double weight = 0.0;  ///< the weights of all samples add up to 1
  double drag_length_mm = 0.0;
  double stiffness_factor = 1.0;  ///< Young's modulus over the specimen's reference
  double bias_mm = 0.0;           ///< to be added to simulated signed errors
};
inline void describe(Visitor& v, PosteriorSample& s) {
  v("weight", s.weight, "Weight of the sample; all weights add up to 1.", {1e-300, 1.0 + 1e-6});
  v({"drag_length_mm", "Speed times dwell: how far the tool travels while it holds a tet.", "mm"}, s.drag_length_mm,
    kAnatomyMm);
  v("stiffness_factor", s.stiffness_factor, "Young's modulus over the specimen's reference.", {1e-3, 1e3});
  v({"bias_mm", "Bias, to be added to simulated signed errors.", "mm"}, s.bias_mm, {-10.0, 10.0});
}

/// The fit of one specimen: signed errors by sector.
struct SpecimenFit {
  std::string name;
  std::vector<double> observed_mm;
  std::vector<double> fitted_mm;       ///< at the posterior means
  double rms_mm = 0.0;                 ///< of their difference
  std::vector<double> simulated_mm;    ///< of a new cut at those values, without the bias; empty: not cut, or open
  std::optional<double> check_rms_mm;  ///< of simulated_mm + bias − fitted_mm: the error of interpolation
};
inline void describe(Visitor& v, SpecimenFit& s) {
  v("name", s.name, "Name of the specimen.");
  v.derived("rms_mm", s.rms_mm, "Root mean square of observed minus fitted errors.");
  v({"check_rms_mm", "Root mean square of simulated minus fitted errors.", "mm"}, s.check_rms_mm);
  v({"observed_mm", "Signed error round the ring, as photographed.", "mm"}, s.observed_mm);
  v({"fitted_mm", "Fitted signed error round the ring, at the posterior means.", "mm"}, s.fitted_mm);
  v.derived("simulated_mm", s.simulated_mm, "Signed error of a new simulated cut at those values.");
}

/// The posterior of (drag length, ln stiffness factor, bias).
struct DragFit {
  ParameterEstimate drag_length_mm;
  ParameterEstimate ln_stiffness;
  ParameterEstimate bias_mm;
  Mat3 correlation = Mat3::Identity();  ///< of the three, in that order
  ResidualEstimate residual;
  std::vector<PosteriorSample> samples;
  std::vector<SpecimenFit> specimens;
  bool knows_stiffness = false;  ///< a second stiffness was cut for every specimen
};

/// Fits the simulated signed errors to the photographed ones, sector by sector:
///   y_s(θ) = m_s(θ; L, κ) + b + δ_s + u_s cos θ + v_s sin θ + r_s(θ),
/// with drag length L, stiffness factor κ and bias b. For specimen s, δ_s is its own bias, (u_s, v_s) the shift of the
/// cut by arm and projection, and r_s a residual that is correlated along the ring. The fit integrates over the sizes
/// of δ, (u, v) and r and over the correlation of r. It works on grids and draws no random number. Simulated waves of
/// more than four per turn are the mesh's grain: they are ignored, except to estimate the grain in the slower waves.
/// See docs/models/calibration.md.
/// @throws InvalidArgument without specimens, for settings or spreads out of range, for profiles that differ in their
/// number of sectors, or if the specimens' ranges of drag length do not overlap.
[[nodiscard]] DragFit fit_drag(const std::vector<FitSpecimen>& specimens, const DragFitSettings& settings = {});

}  // namespace incise
