#pragma once

#include <incise/calibration/drag_fit.hpp>

#include <vector>

namespace incise {

/// One place of the grid of drag length and ln(stiffness factor), the rest integrated over. Given it, the bias is taken
/// for normal with the mean and variance of the mixture over the residual's parameters.
struct PosteriorCell {
  double mass = 0.0;  ///< all together 1
  double bias_mean_mm = 0.0;
  double bias_variance_mm2 = 0.0;
};

struct DragPosterior {
  std::vector<double> drag_lengths_mm;  ///< even, ends included
  std::vector<double> ln_stiffness;     ///< even, symmetric about 0; 0 alone where stiffness was not varied
  std::vector<PosteriorCell> cells;     ///< drag length by drag length
  ResidualEstimate residual;            ///< posterior means
  bool knows_stiffness = false;
  [[nodiscard]] const PosteriorCell& at(std::size_t drag, std::size_t stiffness) const {
    return cells[drag * ln_stiffness.size() + stiffness];
  }
};

/// @pre specimens with equally many sectors, valid settings.
[[nodiscard]] DragPosterior posterior_on_grid(const std::vector<FitSpecimen>& specimens,
                                              const DragFitSettings& settings);

/// Means, deviations, intervals, correlations and samples.
[[nodiscard]] DragFit summary_of(const DragPosterior& posterior, const DragFitSettings& settings);

}  // namespace incise
