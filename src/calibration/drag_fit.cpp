#include "calibration/drag_posterior.hpp"
#include "calibration/sector_noise.hpp"

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

void require_specimens(const std::vector<FitSpecimen>& specimens) {
  INCISE_REQUIRE(!specimens.empty(), "expected at least one specimen");
  const std::size_t sectors = specimens.front().response.sectors();
  for (const FitSpecimen& specimen : specimens) {
    INCISE_REQUIRE(specimen.response.sectors() == sectors && specimen.signed_error_mm.size() == sectors,
                   fmt::format("{}: expected {} sectors, found {} photographed and {} simulated", specimen.name,
                               sectors, specimen.signed_error_mm.size(), specimen.response.sectors()));
    INCISE_REQUIRE(specimen.own_stiffness_sd >= 0.0 && std::isfinite(specimen.own_stiffness_sd),
                   fmt::format("{}: expected own_stiffness_sd of 0 or more", specimen.name));
  }
}

SpecimenFit fitted(const FitSpecimen& specimen, const DragFit& fit) {
  SpecimenFit result;
  result.name = specimen.name;
  result.observed_mm = specimen.signed_error_mm;
  result.fitted_mm = without_fast_waves(specimen.response.at(fit.drag_length_mm.mean));
  const std::vector<double> slope = without_fast_waves(specimen.response.stiffness_slope(fit.drag_length_mm.mean));
  double squares = 0.0;
  for (std::size_t i = 0; i < slope.size(); ++i) {
    result.fitted_mm[i] += fit.ln_stiffness.mean * slope[i] + fit.bias_mm.mean;
    squares += std::pow(result.observed_mm[i] - result.fitted_mm[i], 2);
  }
  result.rms_mm = std::sqrt(squares / static_cast<double>(slope.size()));
  return result;
}

}  // namespace

DragFit fit_drag(const std::vector<FitSpecimen>& specimens, const DragFitSettings& settings) {
  require_none(problems_of(settings));
  require_specimens(specimens);
  const DragPosterior posterior = posterior_on_grid(specimens, settings);
  DragFit fit = summary_of(posterior, settings);
  for (const FitSpecimen& specimen : specimens) fit.specimens.push_back(fitted(specimen, fit));
  return fit;
}

}  // namespace incise
