#pragma once

#include <incise/core/outcome.hpp>
#include <incise/core/workers.hpp>
#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <memory>
#include <span>

namespace incise {

/// Tissue that moves: a value that can be saved, compared and continued with the same bits.
struct Motion {
  TissueState tissue;
  Points velocities_mm_s;  ///< N x 3; on held axes: how fast the holder moves them, 0 unless the caller says otherwise
  double time_s = 0.0;
};
/// At the given state, without speed, at time 0.
[[nodiscard]] Motion motion_at_rest(const TissueModel& model, const TissueState& state);

struct MotionSettings {
  double step_s = 0.01;         ///< > 0
  bool has_inertia = true;      ///< false: quasi-static, every step ends in equilibrium; mass and alpha play no part
  double rayleigh_alpha = 0.0;  ///< 1/s, >= 0: damping force alpha M v
  double rayleigh_beta = 0.0;  ///< s, >= 0: damping force beta K v, K the rotation-frozen stiffness at the step's start
  int max_newton_iterations = 1;  ///< 1: linearly implicit, one linear system a step as SOFA's EulerImplicitSolver does
  double relative_tolerance = 1e-6;  ///< of the step's first right side or 1e-6 E L² (L: the body's box), in (0, 1)
  LinearSolver solver = LinearSolver::Automatic;
  int max_cg_iterations = 4000;  ///< per system
};

struct StepReport {
  Outcome outcome = Outcome::NotConverged;  ///< Success or NotConverged
  int newton_iterations = 0;
  int linear_iterations = 0;       ///< of conjugate gradients
  double relative_residual = 0.0;  ///< of the step's equation where Newton checked it (more than 1 iteration), else of
                                   ///< the linear one's tolerance
};

/// Memory for matrices and vectors, kept from step to step. Never affects a result.
class MotionWorkspace {
 public:
  MotionWorkspace(const TissueModel& model, const MotionSettings& settings);
  ~MotionWorkspace();
  MotionWorkspace(MotionWorkspace&&) noexcept;
  MotionWorkspace& operator=(MotionWorkspace&&) noexcept;

  struct Data;
  [[nodiscard]] Data& data() { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// One step of implicit Euler with lumped mass: x₁ = x₀ + h v₁, M (v₁ − v₀)/h = f(x₁) + loads − (α M + β K₀) v₁, solved
/// by Newton's method from x₀. Forces: elastic, viscous, support planes, gravity and tractions of the model, and
/// `applied_mn` (N x 3, or empty). A step that does not converge leaves `motion` as it was. Order 1 in the step; damps
/// fast vibration (a mode of angular frequency ω loses the factor 1/√(1 + ω² h²) per step). Settings and model must be
/// those that the workspace was made for. Throws InvalidArgument. Source: Baraff and Witkin (1998), eq. 6, for one
/// iteration; SOFA's form of Rayleigh damping.
[[nodiscard]] StepReport advance_motion(const TissueModel& model, Motion& motion, const MotionSettings& settings,
                                        MotionWorkspace& workspace, Workers& workers,
                                        std::span<const Vec3> applied_mn = {});

}  // namespace incise
