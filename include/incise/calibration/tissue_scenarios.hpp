#pragma once

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/describe.hpp>

#include <vector>

namespace incise {

/// A tissue that is simulated for the next specimen.
struct TissueScenario {
  double weight = 0.0;  ///< the weights of all scenarios add up to 1
  double drag_length_mm = 0.0;
  double stiffness_factor = 1.0;  ///< Young's modulus over the specimen's reference
  double bias_mm = 0.0;           ///< expected; to be added to simulated signed errors
};
inline void describe(Visitor& v, TissueScenario& t) {
  v("weight", t.weight, "Weight of the tissue; all weights add up to 1.");
  v({"drag_length_mm", "Speed times dwell.", "mm"}, t.drag_length_mm);
  v("stiffness_factor", t.stiffness_factor, "Young's modulus over the specimen's reference.");
  v({"bias_mm", "Expected bias, to be added to simulated signed errors.", "mm"}, t.bias_mm);
}

/// Returns the tissues to simulate for the next specimen. The first is the one that the posterior expects. If the
/// specimen's own stiffness is uncertain, a softer and a stiffer one follow, by √3 standard deviations, and the weights
/// are 2/3, 1/6 and 1/6. How far real cuts differ from the simulation is not varied here: photographs determine it
/// (RingForecaster).
/// @param own_stiffness_sd  of ln(stiffness factor) of this specimen about its reference, >= 0.
/// @throws InvalidArgument without samples, for a weight, drag length or stiffness that is not above 0, or a spread
/// below 0.
[[nodiscard]] std::vector<TissueScenario> tissue_scenarios(const std::vector<PosteriorSample>& samples,
                                                           double own_stiffness_sd);

}  // namespace incise
