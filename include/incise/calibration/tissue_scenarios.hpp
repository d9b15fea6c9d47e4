#pragma once

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/describe.hpp>

#include <vector>

namespace incise {

/// A tissue that is simulated for the next specimen.
struct TissueScenario {
  double weight = 0.0;  ///< all together 1
  double drag_length_mm = 0.0;
  double stiffness_factor = 1.0;  ///< Young's modulus over the specimen's reference
  double bias_mm = 0.0;           ///< expected; to be added to simulated signed errors
};
inline void describe(Visitor& v, TissueScenario& t) {
  v("weight", t.weight, "All together 1.");
  v({"drag_length_mm", "Speed times dwell.", "mm"}, t.drag_length_mm);
  v("stiffness_factor", t.stiffness_factor, "Young's modulus over the specimen's reference.");
  v({"bias_mm", "Expected; to be added to simulated signed errors.", "mm"}, t.bias_mm);
}

/// The tissue that a posterior expects, the first; and, where the specimen's own stiffness is not known, one softer and
/// one stiffer by √3 standard deviations, with weights of 2/3, 1/6 and 1/6. How far real cuts lie from what it says is
/// not varied here: photographs tell that (RingForecaster).
/// @param own_stiffness_sd  of ln(stiffness factor), by which this specimen may differ from its reference, >= 0.
/// @throws InvalidArgument without samples, for weights that are not above 0, or a spread below 0.
[[nodiscard]] std::vector<TissueScenario> tissue_scenarios(const std::vector<PosteriorSample>& samples,
                                                           double own_stiffness_sd);

}  // namespace incise
