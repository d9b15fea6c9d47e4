#include "mechanics/reactions.hpp"
#include "mechanics/tangent_solver.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace incise {

struct MotionWorkspace::Data {
  BlockMatrix matrix;
  std::optional<BlockMatrix> start_stiffness;  // K₀ for damping; Newton overwrites `matrix`
  TangentSolver solver;
  Points right, increment, moved, product;
  std::vector<std::uint8_t> loose;

  Data(const TissueModel& model, const MotionSettings& settings)
      : matrix(model.pattern),
        solver(model, settings.solver, settings.max_cg_iterations),
        right(model.mesh.vertices.size()),
        increment(right.size()),
        moved(right.size()),
        product(right.size()),
        loose(right.size()) {}
};

namespace {

constexpr std::size_t kValuesPerChunk = 65536;

void check(const MotionSettings& settings) {
  const auto is_at_least_0 = [](double value) { return std::isfinite(value) && value >= 0.0; };
  INCISE_REQUIRE(std::isfinite(settings.step_s) && settings.step_s > 0.0,
                 fmt::format("expected step_s above 0, found {}", settings.step_s));
  INCISE_REQUIRE(is_at_least_0(settings.rayleigh_alpha) && is_at_least_0(settings.rayleigh_beta),
                 fmt::format("expected Rayleigh coefficients of 0 or more, found {} and {}", settings.rayleigh_alpha,
                             settings.rayleigh_beta));
  INCISE_REQUIRE(settings.max_newton_iterations > 0 && settings.max_cg_iterations > 0,
                 fmt::format("expected at least 1 iteration, found {} and {}", settings.max_newton_iterations,
                             settings.max_cg_iterations));
  INCISE_REQUIRE(settings.relative_tolerance > 0.0 && settings.relative_tolerance < 1.0,
                 fmt::format("expected relative_tolerance in (0, 1), found {}", settings.relative_tolerance));
}

/// One step. `tissue_` is the trial state; the motion itself changes only in finish().
class Step {
 public:
  Step(const TissueModel& model, const Motion& motion, const MotionSettings& settings, MotionWorkspace::Data& scratch,
       Workers& workers, std::span<const Vec3> applied)
      : model_(model),
        motion_(motion),
        settings_(settings),
        scratch_(scratch),
        workers_(workers),
        applied_(applied),
        tissue_(motion.tissue),
        free_(free_axes(model, motion.tissue)) {
    for (std::size_t v = 0; v < free_.size(); ++v) {
      scratch_.loose[v] = free_[v].isZero(0.0) ? 1 : 0;
      for (int i = 0; i < 3; ++i) {
        const bool is_held = model_.is_fixed[v][static_cast<std::size_t>(i)];
        scratch_.moved[v][i] = is_held ? settings_.step_s * motion_.velocities_mm_s[v][i] : 0.0;
      }
      is_carried_ = is_carried_ || !scratch_.moved[v].isZero(0.0);
    }
    scratch_.solver.forget();
  }

  StepReport run() {
    const int before = scratch_.solver.cg_iterations();
    StepReport report;
    double scale = 0.0;
    for (int i = 0; i <= settings_.max_newton_iterations; ++i) {
      const bool is_first = i == 0;
      if (!is_first && settings_.max_newton_iterations == 1) {
        report.outcome = Outcome::Success;
        report.relative_residual = settings_.relative_tolerance;
        break;
      }
      find_forces(is_first ? Tangent::FrozenRotations : Tangent::Exact, is_first);
      const double size = free_norm(scratch_.right, free_);
      if (is_first) scale = std::max(size, negligible_force_mn(model_));
      if (!std::isfinite(size)) break;
      report.relative_residual = size / scale;
      if (is_first ? size == 0.0 && !is_carried_ : report.relative_residual <= settings_.relative_tolerance) {
        report.outcome = Outcome::Success;
        break;
      }
      if (i == settings_.max_newton_iterations || !find_increment(is_first, size > 0.0 ? scale / size : 1.0)) break;
      for (std::size_t v = 0; v < free_.size(); ++v) {
        tissue_.positions[v] += scratch_.increment[v];
        if (is_first) tissue_.positions[v] += scratch_.moved[v];
      }
      ++report.newton_iterations;
    }
    report.linear_iterations = scratch_.solver.cg_iterations() - before;
    return report;
  }

  /// Stores the end of the step in `motion`.
  void finish(Motion& motion) {
    for (std::size_t v = 0; v < free_.size(); ++v) {
      motion.velocities_mm_s[v] = (tissue_.positions[v] - motion.tissue.positions[v]) / settings_.step_s;
    }
    end_viscous_step(model_, tissue_, settings_.step_s, workers_);
    motion.tissue = std::move(tissue_);
    motion.time_s += settings_.step_s;
  }

 private:
  /// Computes the step's right side at the trial positions, and its matrix M (1/h² + α/h) + K + (β/h) K₀.
  void find_forces(Tangent tangent, bool is_first) {
    Points& right = scratch_.right;
    right = model_.dead_load_mn;
    for (std::size_t v = 0; v < applied_.size(); ++v) right[v] += applied_[v];
    std::vector<double>& values = scratch_.matrix.values;
    std::fill(values.begin(), values.end(), 0.0);
    add_elastic_response(model_, tissue_, right, &scratch_.matrix, workers_, tangent);
    add_damping(is_first);
    add_viscous_response(model_, tissue_, settings_.step_s, right, &scratch_.matrix, workers_, tangent);
    add_support_response(model_, tissue_, right, &scratch_.matrix);
    if (settings_.has_inertia) add_inertia();
    if (is_first && is_carried_) {  // held vertices carry the tissue along, by the linear response
      multiply(scratch_.matrix, scratch_.moved, scratch_.product, workers_);
      for (std::size_t v = 0; v < right.size(); ++v) right[v] -= scratch_.product[v];
    }
  }

  /// Adds the damping β K₀ (x - x₀)/h. In the first iteration x = x₀, and K₀ is the matrix assembled so far.
  void add_damping(bool is_first) {
    if (settings_.rayleigh_beta == 0.0) return;
    const double share = settings_.rayleigh_beta / settings_.step_s;
    std::vector<double>& values = scratch_.matrix.values;
    if (is_first) {
      if (settings_.max_newton_iterations > 1) scratch_.start_stiffness = scratch_.matrix;
      workers_.for_each(values.size(), kValuesPerChunk, [&](std::size_t i) { values[i] *= 1.0 + share; });
      return;
    }
    Points& way = scratch_.increment;  // free between two systems
    for (std::size_t v = 0; v < way.size(); ++v) way[v] = tissue_.positions[v] - motion_.tissue.positions[v];
    multiply(*scratch_.start_stiffness, way, scratch_.product, workers_);
    for (std::size_t v = 0; v < way.size(); ++v) scratch_.right[v] -= share * scratch_.product[v];
    const std::vector<double>& start = scratch_.start_stiffness->values;
    workers_.for_each(values.size(), kValuesPerChunk, [&](std::size_t i) { values[i] += share * start[i]; });
  }

  void add_inertia() {
    const double h = settings_.step_s;
    for (std::size_t v = 0; v < free_.size(); ++v) {
      const double mass = model_.vertex_mass_kg[v];
      const Vec3 velocity = (tissue_.positions[v] - motion_.tissue.positions[v]) / h;
      scratch_.right[v] += mass * ((motion_.velocities_mm_s[v] - velocity) / h - settings_.rayleigh_alpha * velocity);
      double* block = scratch_.matrix.block(model_.pattern->diagonal[v]);
      for (std::size_t i = 0; i < 3; ++i) block[4 * i] += mass * (1.0 / h + settings_.rayleigh_alpha) / h;
    }
  }

  /// Solves for the increment; if the exact tangent is not positive definite, with the projected one.
  bool find_increment(bool is_first, double scale_over_size) {
    const double tolerance = is_first ? 0.5 * settings_.relative_tolerance
                                      : std::min(0.5, 0.5 * settings_.relative_tolerance * scale_over_size);
    hold_constrained(model_, scratch_.matrix, scratch_.right, scratch_.loose);
    TangentSolver::End end =
        scratch_.solver.solve(scratch_.matrix, scratch_.right, scratch_.increment, tolerance, workers_);
    if (end == TangentSolver::End::NotPositiveDefinite && !is_first) {
      find_forces(Tangent::Projected, false);
      hold_constrained(model_, scratch_.matrix, scratch_.right, scratch_.loose);
      end = scratch_.solver.solve(scratch_.matrix, scratch_.right, scratch_.increment, tolerance, workers_);
    }
    return end == TangentSolver::End::Solved;
  }

  const TissueModel& model_;
  const Motion& motion_;
  const MotionSettings& settings_;
  MotionWorkspace::Data& scratch_;
  Workers& workers_;
  std::span<const Vec3> applied_;
  TissueState tissue_;
  Points free_;  // 1 along axes that may move, 0 along held ones and at vertices without a live tet
  bool is_carried_ = false;
};

}  // namespace

MotionWorkspace::MotionWorkspace(const TissueModel& model, const MotionSettings& settings) {
  check(settings);
  data_ = std::make_unique<Data>(model, settings);
}
MotionWorkspace::~MotionWorkspace() = default;
MotionWorkspace::MotionWorkspace(MotionWorkspace&&) noexcept = default;
MotionWorkspace& MotionWorkspace::operator=(MotionWorkspace&&) noexcept = default;

Motion motion_at_rest(const TissueModel& model, const TissueState& state) {
  return {state, Points(model.mesh.vertices.size(), Vec3::Zero()), 0.0};
}

StepReport advance_motion(const TissueModel& model, Motion& motion, const MotionSettings& settings,
                          MotionWorkspace& workspace, Workers& workers, std::span<const Vec3> applied_mn) {
  check(settings);
  const std::size_t count = model.mesh.vertices.size();
  INCISE_REQUIRE(motion.tissue.positions.size() == count && motion.velocities_mm_s.size() == count,
                 fmt::format("expected {} positions and velocities, found {} and {}", count,
                             motion.tissue.positions.size(), motion.velocities_mm_s.size()));
  INCISE_REQUIRE(applied_mn.empty() || applied_mn.size() == count,
                 fmt::format("expected {} applied forces or none, found {}", count, applied_mn.size()));
  INCISE_REQUIRE(workspace.data().matrix.pattern == model.pattern, "expected a workspace made for this model");
  Step step(model, motion, settings, workspace.data(), workers, applied_mn);
  const StepReport report = step.run();
  if (report.outcome == Outcome::Success) step.finish(motion);
  return report;
}

}  // namespace incise
