#pragma once

#include <incise/core/outcome.hpp>
#include <incise/core/workers.hpp>
#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <memory>
#include <span>

namespace incise {

/// Moving tissue: a value that can be saved, compared and continued with the same bits.
struct Motion {
  TissueState tissue;
  Points velocities_mm_s;  ///< N x 3; on held axes the prescribed velocity, 0 unless the caller sets it
  double time_s = 0.0;
};
/// Returns the given state with zero velocity, at time 0.
[[nodiscard]] Motion motion_at_rest(const TissueModel& model, const TissueState& state);

struct MotionSettings {
  double step_s = 0.01;         ///< > 0
  bool has_inertia = true;      ///< false: quasi-static, every step ends in equilibrium; mass and alpha have no effect
  double rayleigh_alpha = 0.0;  ///< 1/s, >= 0: damping force alpha M v
  double rayleigh_beta = 0.0;  ///< s, >= 0: damping force beta K v; K: rotation-frozen elastic stiffness at step start
  int max_newton_iterations = 1;  ///< 1: linearly implicit, one linear system per step, as SOFA's EulerImplicitSolver
  double relative_tolerance = 1e-6;  ///< (0, 1); relative to the larger of the step's first right side and 1e-6 E L²
                                     ///< (L: diagonal of the body's box)
  LinearSolver solver = LinearSolver::Automatic;
  int max_cg_iterations = 4000;  ///< per linear system
};

struct StepReport {
  Outcome outcome = Outcome::NotConverged;  ///< Success or NotConverged
  int newton_iterations = 0;
  int linear_iterations = 0;       ///< of conjugate gradients
  double relative_residual = 0.0;  ///< of the step's equation, last one measured; if max_newton_iterations is 1 and the
                                   ///< linear system was solved: relative_tolerance
};

/// Memory for matrices and vectors, reused from step to step. Never affects a result.
class MotionWorkspace {
 public:
  /// @throws InvalidArgument for a setting out of range.
  MotionWorkspace(const TissueModel& model, const MotionSettings& settings);
  ~MotionWorkspace();
  MotionWorkspace(MotionWorkspace&&) noexcept;
  MotionWorkspace& operator=(MotionWorkspace&&) noexcept;

  struct Data;
  [[nodiscard]] Data& data() { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// Takes one step of implicit Euler with lumped mass: x₁ = x₀ + h v₁, M (v₁ − v₀)/h = f(x₁) + loads − (α M + β K₀) v₁,
/// solved by Newton's method from x₀. Forces: elastic, viscous, supports, gravity and tractions of the model, and
/// `applied_mn` (N x 3, mN, or empty). A step that does not converge leaves `motion` unchanged. First order in the
/// step; damps fast vibration (the amplitude of a mode of angular frequency ω falls by the factor 1/√(1 + ω² h²) per
/// step).
/// @pre model and settings are those that the workspace was made for.
/// @throws InvalidArgument for a setting out of range, arrays of the wrong size or a workspace of another model.
/// Source: Baraff and Witkin (1998), eq. 6, for one iteration; SOFA's form of Rayleigh damping.
[[nodiscard]] StepReport advance_motion(const TissueModel& model, Motion& motion, const MotionSettings& settings,
                                        MotionWorkspace& workspace, Workers& workers,
                                        std::span<const Vec3> applied_mn = {});

}  // namespace incise
