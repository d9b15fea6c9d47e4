#pragma once

#include <incise/calibration/calibration_run.hpp>
#include <incise/calibration/drag_response.hpp>
#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// One photographed cut and what the simulation of that specimen says.
struct FitSpecimen {
  std::string name;
  std::vector<double> signed_error_mm;  ///< photographed, by sector
  DragResponse response;                ///< simulated, with as many sectors
  double own_stiffness_sd = 0.0;        ///< of ln(Young's modulus), by which this specimen's reference may be off, >= 0
};

/// The prior, assumed before the photographs are considered. The drag length is uniform where all specimens were
/// simulated.
struct DragFitSettings {
  double stiffness_sd = 0.5;
  double bias_sd_mm = 0.5;
  double reading_sd_mm = 0.1;
  double credible = 0.9;
  int samples = 64;
};
inline void describe(Visitor& v, DragFitSettings& s) {
  v("stiffness_sd", s.stiffness_sd, "Of ln(stiffness factor) common to all specimens; its mean is 0.", kPositive);
  v({"bias_sd_mm", "Of the common bias; its mean is 0.", "mm"}, s.bias_sd_mm, kPositive);
  v({"reading_sd_mm",
     "Of a sector's error for reading the photograph and the mesh's grain; independent of the others'.", "mm"},
    s.reading_sd_mm, kPositive);
  v("credible", s.credible, "Mass of the credible intervals.", {0.0, 1.0, true, true});
  v("samples", s.samples, "Of the posterior.", {1.0});
}

/// What the data say about one parameter.
struct ParameterEstimate {
  double mean = 0.0;
  double sd = 0.0;
  double low = 0.0;  ///< ends of the equal-tailed credible interval
  double high = 0.0;
  double prior_sd = 0.0;
  std::vector<double> grid;     ///< places at which the marginal density is given
  std::vector<double> density;  ///< integrates to 1
};
inline void describe(Visitor& v, ParameterEstimate& e) {
  v("mean", e.mean, "Of the posterior.");
  v("sd", e.sd, "Of the posterior.");
  v("low", e.low, "Lower end of the equal-tailed credible interval.");
  v("high", e.high, "Its upper end.");
  v("prior_sd", e.prior_sd, "Of the prior.");
  v("grid", e.grid, "Places at which the marginal density is given.");
  v("density", e.density, "There; it integrates to 1.");
}

/// What simulation and photograph differ by, estimated from the data.
struct ResidualEstimate {
  double sd_mm = 0.0;            ///< along the contour
  double correlation_deg = 0.0;  ///< angle over which the correlation falls to 1/e
  double reading_mm = 0.0;       ///< from sector to sector, independent: reading of the photograph, grain of the mesh
  double specimen_spread_mm = 0.0;  ///< sd of the bias from specimen to specimen about the common one
  double placement_mm = 0.0;        ///< sd, along each axis of the picture, of the shift of a cut as a whole
  double n_effective = 0.0;         ///< independent places that one contour is worth, for its mean
};
inline void describe(Visitor& v, ResidualEstimate& r) {
  v({"sd_mm", "Along the contour.", "mm"}, r.sd_mm, kAnatomyMm);
  v({"correlation_deg", "Angle over which the correlation falls to 1/e.", "deg"}, r.correlation_deg, {1e-6, 1e5});
  v({"reading_mm", "From sector to sector, independent.", "mm"}, r.reading_mm, kAnatomyMm);
  v({"specimen_spread_mm", "Of the bias from specimen to specimen.", "mm"}, r.specimen_spread_mm, kAnatomyMm);
  v({"placement_mm", "Of the shift of a cut as a whole, along each axis.", "mm"}, r.placement_mm, kAnatomyMm);
  v("n_effective", r.n_effective, "Independent places that one contour is worth.", {1e-6, 1e6});
}

struct PosteriorSample {
  double weight = 0.0;  ///< all together 1
  double drag_length_mm = 0.0;
  double stiffness_factor = 1.0;
  double bias_mm = 0.0;  ///< to be added to simulated signed errors
};
inline void describe(Visitor& v, PosteriorSample& s) {
  v("weight", s.weight, "All together 1.", {1e-300, 1.0 + 1e-6});
  v({"drag_length_mm", "How far held tissue is drawn along.", "mm"}, s.drag_length_mm, kAnatomyMm);
  v("stiffness_factor", s.stiffness_factor, "Over the reference.", {1e-3, 1e3});
  v({"bias_mm", "To be added to simulated signed errors.", "mm"}, s.bias_mm, {-10.0, 10.0});
}

struct SpecimenFit {
  std::string name;
  std::vector<double> observed_mm;
  std::vector<double> fitted_mm;       ///< at the posterior means
  double rms_mm = 0.0;                 ///< of their difference
  std::vector<double> simulated_mm;    ///< cut anew at those values, without the bias; empty: not done, or no ring
  std::optional<double> check_rms_mm;  ///< between that and what the straight lines say
};
inline void describe(Visitor& v, SpecimenFit& s) {
  v("name", s.name, "Of the specimen.");
  v.derived("rms_mm", s.rms_mm, "Of observed less fitted errors.");
  v({"check_rms_mm", "Of simulated less fitted errors.", "mm"}, s.check_rms_mm);
  v({"observed_mm", "Signed error round the ring, as photographed.", "mm"}, s.observed_mm);
  v({"fitted_mm", "The same at the posterior means.", "mm"}, s.fitted_mm);
  v.derived("simulated_mm", s.simulated_mm, "The same, cut anew at those values.");
}

/// The posterior of (drag length, ln stiffness factor, bias).
struct DragFit {
  ParameterEstimate drag_length_mm;
  ParameterEstimate ln_stiffness;
  ParameterEstimate bias_mm;
  Mat3 correlation = Mat3::Identity();  ///< in that order
  ResidualEstimate residual;
  std::vector<PosteriorSample> samples;
  std::vector<SpecimenFit> specimens;
  bool knows_stiffness = false;  ///< a second stiffness was cut for every specimen
};

/// Fits the simulated signed errors to the photographed ones, sector by sector:
///   y_s(θ) = m_s(θ; L, κ) + b + δ_s + u_s cos θ + v_s sin θ + r_s(θ),
/// δ_s from specimen to specimen, (u_s, v_s) by where arm and projection placed the cut, r_s correlated along the ring.
/// The sizes of δ, (u, v) and r and the correlation of r are integrated over, not chosen. Everything is on grids: no
/// random number is drawn. The simulation's waves of more than four per turn are ignored: they are its
/// mesh's grain, and tell how much of that is in the slower ones. See docs/models/calibration.md.
/// @throws InvalidArgument without specimens, for settings or profiles that do not fit, or where the ranges of drag
/// length of the specimens do not overlap.
[[nodiscard]] DragFit fit_drag(const std::vector<FitSpecimen>& specimens, const DragFitSettings& settings = {});

}  // namespace incise
