#pragma once

#include <incise/cutting/cut_settings.hpp>

#include <cstdint>
#include <optional>

namespace incise::testing {

/// How well the planner's own simulation can be made to follow one cut of the virtual bench.
struct PlannerFit {
  double seen_mean_abs_mm = 0.0;                            ///< of the bench's cut
  double seen_sd_mm = 0.0;                                  ///< of its signed error along the ring
  double residual_rms_mm = 0.0;                             ///< of signed errors, what the best simulation leaves
  double dullness = 0.0, modulus_kpa = 0.0, bias_mm = 0.0;  ///< of that simulation, at 13 mm/s
  int open_simulations = 0;
};

/// The simulation of the specimen's shape is cut with five drag lengths (speed times dullness) and two stiffnesses;
/// between neighbouring drag lengths its signed error by 36 directions is interpolated, a constant bias is free, and
/// the least squares are taken: what is left is what no calibration of these parameters can remove. One thread.
/// @param tets  of the simulation's mesh, about. @param cut  of its cuts; the dullness is not read. @returns nothing
/// where the bench's ring stayed open.
[[nodiscard]] std::optional<PlannerFit> fit_planner_to_bench(std::uint64_t seed, int tets, const CutSettings& cut = {});

/// The band that the bench was made for: residuals below would mean that the planner knows the bench's physics, above
/// that nothing can be planned by it.
inline constexpr double kLeastResidualMm = 0.25;
inline constexpr double kMostResidualMm = 0.6;

}  // namespace incise::testing
