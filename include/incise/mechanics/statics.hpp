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
  double relative_tolerance = 1e-6;  ///< (0, 1); of |residual on free axes| / max(|reactions|, |loads|, 1e-6 E L²)
                                     ///< (L: diagonal of the body's box)
  int max_newton_iterations = 60;    ///< >= 1; over all load steps
  double first_load_fraction = 1.0;  ///< (0, 1]; size of the first load step, halved automatically if Newton stalls
  LinearSolver solver = LinearSolver::Automatic;
};

/// Static equilibrium under the model's constraints.
struct StaticResult {
  Outcome outcome = Outcome::NotConverged;  ///< Success, NotConverged, ElementInverted or Cancelled
  TissueState state;
  int iterations = 0;
  int load_steps = 0;
  int linear_iterations = 0;  ///< of conjugate gradients, over all systems
  double relative_residual = std::numeric_limits<double>::quiet_NaN();  ///< last one measured; NaN: none was
  std::vector<double> residual_history;  ///< every relative_residual that was measured
  std::vector<Vec3> reactions_mn;  ///< one per entry of model.constraints: the force of the constraint on the tissue
  double max_displacement_mm = 0.0;
  double penetration_mm = 0.0;  ///< of the deepest vertex behind a support; above 0.05 the monitor gets a warning
  std::size_t inverted_tets = 0;
  double wall_s = 0.0;
  std::string solver;  ///< the solver that was chosen, and why; for a person
};
/// Explains to a person why a stretch failed and what may help; empty if it succeeded.
[[nodiscard]] std::string explain_stretch(const StaticResult& stretched);
inline void describe(Visitor& v, StaticResult& r) {
  v("outcome", r.outcome, "How the search for equilibrium ended.");
  v.derived("converged", r.outcome == Outcome::Success, "Whether the stretch succeeded.");
  v.derived("note", explain_stretch(r), "Why the stretch failed and what may help; empty if it succeeded.");
  v.bulk("state", r.state, "The tissue at the end.");
  v("iterations", r.iterations, "Number of Newton steps.");
  v("load_steps", r.load_steps, "Number of steps in which the load was applied.");
  v("linear_iterations", r.linear_iterations, "Number of iterations of conjugate gradients.");
  v.bulk("relative_residual", r.relative_residual, "Last relative residual measured; not a number: none was.");
  v.derived("relative_residual", std::isfinite(r.relative_residual) ? std::optional(r.relative_residual) : std::nullopt,
            "Last relative residual measured.");
  v.bulk("residual_history", r.residual_history, "Relative residuals, one for each Newton step.");
  v("reaction_mn", r.reactions_mn, "Force of each constraint on the tissue.");
  v("max_displacement_mm", r.max_displacement_mm, "Greatest displacement of a vertex.");
  v("penetration_mm", r.penetration_mm, "Depth of the deepest vertex behind a support.");
  v("inverted_tets", r.inverted_tets, "Number of inverted tets.");
  v("wall_s", r.wall_s, "Time that the search took.");
  v("solver", r.solver, "The solver that was chosen, and why.");
}

/// Finds static equilibrium by Newton's method with a line search on residual and energy, from `start` (null: rest).
/// The prescribed displacements, and the forces that are out of balance at the start, are applied in load steps of
/// adaptive size. Every failure is an outcome. Cost: one linear system per iteration (two where the exact tangent is
/// not positive definite), solved to rounding by Cholesky or only as accurately as the iteration needs by conjugate
/// gradients. `monitor` receives a message for every iteration. @throws InvalidArgument for a setting out of range.
[[nodiscard]] StaticResult solve_static(const TissueModel& model, const StaticSettings& settings, Workers& workers,
                                        Monitor& monitor, const TissueState* start = nullptr);

/// Returns the von Mises stress of each tet, kPa; 0 for carved ones. It is that of the Cauchy stress P Fᵀ / J for
/// StableNeoHookean, and of P Rᵀ (small strains in the rotated frame) for Corotational and for inverted tets. Without
/// viscous stress.
[[nodiscard]] std::vector<double> von_mises_kpa(const TissueModel& model, const TissueState& state);

}  // namespace incise
