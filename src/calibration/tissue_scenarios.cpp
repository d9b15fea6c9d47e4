#include <incise/calibration/tissue_scenarios.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace incise {

std::vector<TissueScenario> tissue_scenarios(const std::vector<PosteriorSample>& samples, double own_stiffness_sd) {
  INCISE_REQUIRE(!samples.empty(), "expected at least one sample of a posterior");
  INCISE_REQUIRE(own_stiffness_sd >= 0.0 && std::isfinite(own_stiffness_sd),
                 fmt::format("expected a spread of 0 or more, found {}", own_stiffness_sd));
  double weights = 0.0, drag_mm = 0.0, ln_stiffness = 0.0, bias_mm = 0.0;
  for (const PosteriorSample& s : samples) {
    INCISE_REQUIRE(
        s.weight > 0.0 && s.drag_length_mm > 0.0 && s.stiffness_factor > 0.0 && std::isfinite(s.bias_mm),
        fmt::format("expected samples with numbers above 0, found weight {}, drag length {} mm, stiffness {}", s.weight,
                    s.drag_length_mm, s.stiffness_factor));
    weights += s.weight;
    drag_mm += s.weight * s.drag_length_mm;
    ln_stiffness += s.weight * std::log(s.stiffness_factor);
    bias_mm += s.weight * s.bias_mm;
  }
  const TissueScenario middle{1.0, drag_mm / weights, std::exp(ln_stiffness / weights), bias_mm / weights};
  if (!(own_stiffness_sd > 0.0)) return {middle};
  std::vector<TissueScenario> tissues(3, middle);
  tissues[0].weight = 2.0 / 3.0;
  for (const std::size_t k : {1U, 2U}) {
    tissues[k].weight = 1.0 / 6.0;
    tissues[k].stiffness_factor *= std::exp((k == 1 ? -1.0 : 1.0) * std::numbers::sqrt3 * own_stiffness_sd);
  }
  return tissues;
}

}  // namespace incise
