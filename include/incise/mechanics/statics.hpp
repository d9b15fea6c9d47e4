#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/core/workers.hpp>
#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <cmath>
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
  double penetration_mm = 0.0;  ///< deepest vertex behind a support; more than 0.05 is reported as a warning
  std::size_t inverted_tets = 0;
  double wall_s = 0.0;
  std::string solver;  ///< what was chosen and why, for a person
};
/// Why a stretch is of no use and what may help, for a person; empty when it is a success.
[[nodiscard]] std::string explain_stretch(const StaticResult& stretched);
inline void describe(Visitor& v, StaticResult& r) {
  v("outcome", r.outcome, "How the search for equilibrium ended.");
  v.derived("converged", r.outcome == Outcome::Success, "Whether it is a success.");
  v.derived("note", explain_stretch(r), "Why it is of no use and what may help; empty when it is a success.");
  v.bulk("state", r.state, "The tissue then.");
  v("iterations", r.iterations, "Newton steps.");
  v("load_steps", r.load_steps, "Steps in which the load was applied.");
  v("linear_iterations", r.linear_iterations, "Of conjugate gradients.");
  v.bulk("relative_residual", r.relative_residual, "Last one measured; not a number: none was.");
  v.derived("relative_residual", std::isfinite(r.relative_residual) ? std::optional(r.relative_residual) : std::nullopt,
            "Last one measured.");
  v.bulk("residual_history", r.residual_history, "One for each Newton step.");
  v("reaction_mn", r.reactions_mn, "Force of each constraint on the tissue.");
  v("max_displacement_mm", r.max_displacement_mm, "Farthest that a vertex moved.");
  v("penetration_mm", r.penetration_mm, "Deepest vertex behind a support.");
  v("inverted_tets", r.inverted_tets, "How many.");
  v("wall_s", r.wall_s, "Time that it took.");
  v("solver", r.solver, "What was chosen and why.");
}

/// Newton with line search on the energy/residual, from `start` (default: rest): the prescribed displacements are
/// spread over load steps that adapt by themselves. Every failure is an outcome. Cost: one linear system per iteration,
/// solved exactly by Cholesky or as well as the iteration deserves by conjugate gradients. `monitor` hears of every
/// iteration.
[[nodiscard]] StaticResult solve_static(const TissueModel& model, const StaticSettings& settings, Workers& workers,
                                        Monitor& monitor, const TissueState* start = nullptr);

/// Von Mises stress of each live tet (0 for carved ones), kPa (Cauchy stress of the corotational law: R σ Rᵀ).
[[nodiscard]] std::vector<double> von_mises_kpa(const TissueModel& model, const TissueState& state);

}  // namespace incise
