#pragma once

#include <incise/calibration/drag_fit.hpp>

#include <vector>

namespace incise {

/// One cell of the grid of drag length and ln(stiffness factor); all other parameters are integrated over. Within a
/// cell, the bias is taken as normal, with the mean and variance of its mixture over the residual's parameters.
struct PosteriorCell {
  double mass = 0.0;  ///< the masses of all cells add up to 1
  double bias_mean_mm = 0.0;
  double bias_variance_mm2 = 0.0;
};

/// Posterior on the grid.
struct DragPosterior {
  std::vector<double> drag_lengths_mm;  ///< evenly spaced, ends included
  std::vector<double> ln_stiffness;     ///< evenly spaced, symmetric about 0; only 0 if stiffness was not varied
  std::vector<PosteriorCell> cells;     ///< drag length by drag length
  ResidualEstimate residual;            ///< posterior means
  bool knows_stiffness = false;
  [[nodiscard]] const PosteriorCell& at(std::size_t drag, std::size_t stiffness) const {
    return cells[drag * ln_stiffness.size() + stiffness];
  }
};

/// Computes the posterior on the grid. @pre specimens with equally many sectors, valid settings. @throws
/// InvalidArgument if the specimens' ranges of drag length do not overlap.
[[nodiscard]] DragPosterior posterior_on_grid(const std::vector<FitSpecimen>& specimens,
                                              const DragFitSettings& settings);

/// Summarises the posterior: means, deviations, intervals, correlations and samples.
[[nodiscard]] DragFit summary_of(const DragPosterior& posterior, const DragFitSettings& settings);

}  // namespace incise
