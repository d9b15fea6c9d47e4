#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/core/workers.hpp>
#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <limits>
#include <string>
#include <vector>

namespace incise {

struct StaticSettings {
  double relative_tolerance = 1e-6;  ///< |free residual| / max(|reactions|, floor)
  int max_newton_iterations = 60;    ///< in all
  double first_load_fraction = 1.0;  ///< of the prescribed displacements; halved by itself when Newton stalls
  LinearSolver solver = LinearSolver::Automatic;
};

/// Static equilibrium under the model's constraints.
struct StaticResult {
  Outcome outcome = Outcome::NotConverged;  ///< Success, NotConverged, ElementInverted or Cancelled
  TissueState state;
  int iterations = 0;
  int load_steps = 0;
  int linear_iterations = 0;  ///< of conjugate gradients, in all
  double relative_residual = std::numeric_limits<double>::quiet_NaN();  ///< last one measured; NaN: none was
  std::vector<double> residual_history;
  std::vector<Vec3> reactions_mn;  ///< one per entry of model.constraints: the force of the constraint on the tissue
  double max_displacement_mm = 0.0;
  double penetration_mm = 0.0;  ///< deepest vertex behind a support; more than 0.05 is told as a warning
  std::size_t inverted_tets = 0;
  double wall_s = 0.0;
  std::string solver;  ///< what was chosen and why, for a person
};

/// Newton with line search on the energy/residual, from `start` (default: rest): the prescribed displacements are
/// spread over load steps that adapt by themselves. Every failure is an outcome. Cost: one linear system per iteration,
/// solved exactly by Cholesky or as well as the iteration deserves by conjugate gradients. `monitor` hears of every
/// iteration.
[[nodiscard]] StaticResult solve_static(const TissueModel& model, const StaticSettings& settings, Workers& workers,
                                        Monitor& monitor, const TissueState* start = nullptr);

/// Von Mises stress of each live tet (0 for carved ones), kPa (Cauchy stress of the corotational law: R σ Rᵀ).
[[nodiscard]] std::vector<double> von_mises_kpa(const TissueModel& model, const TissueState& state);

}  // namespace incise
