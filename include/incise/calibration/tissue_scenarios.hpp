#pragma once

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/describe.hpp>

#include <vector>

namespace incise {

/// One tissue of those that a calibration leaves possible for the next specimen.
struct TissueScenario {
  double weight = 0.0;  ///< all together 1
  double drag_length_mm = 0.0;
  double stiffness_factor = 1.0;  ///< Young's modulus over the specimen's reference
  double bias_mm = 0.0;           ///< expected, given the two; to be added to simulated signed errors
};
inline void describe(Visitor& v, TissueScenario& t) {
  v("weight", t.weight, "All together 1.");
  v({"drag_length_mm", "Speed times dwell.", "mm"}, t.drag_length_mm);
  v("stiffness_factor", t.stiffness_factor, "Young's modulus over the specimen's reference.");
  v({"bias_mm", "Expected, given the two; to be added to simulated signed errors.", "mm"}, t.bias_mm);
}

/// What is assumed about the next specimen: a few tissues to simulate, and what needs no simulation.
struct TissueScenarios {
  std::vector<TissueScenario> points;  ///< the first: the middle
  double drag_length_sd_mm = 0.0;
  double ln_stiffness_sd = 0.0;  ///< the specimen's own included
  double bias_sd_mm = 0.0;       ///< the spread from specimen to specimen included
  double common_sd_mm = 0.0;     ///< of the bias about the points' own: the same all round a cut
};

/// Replaces a posterior by five weighted tissues with its mean and covariance of (drag length, ln stiffness factor):
/// the middle (1/3) and two on either side along the axes of its Cholesky factor (1/6 each), √3 standard deviations
/// out. Of the bias, which needs no simulation, each holds what is expected there; the rest is common_sd_mm. A drag
/// length beyond those of the samples is drawn to the last one: where the posterior ends because no ring closed there
/// is none to simulate, and the reported spread is a little too large.
/// @param own_stiffness_sd  of ln(stiffness factor), by which this specimen may differ from its reference, >= 0.
/// @throws InvalidArgument without samples, for weights that are not above 0, or a spread below 0.
[[nodiscard]] TissueScenarios tissue_scenarios(const std::vector<PosteriorSample>& samples,
                                               const ResidualEstimate& residual, double own_stiffness_sd);

}  // namespace incise
