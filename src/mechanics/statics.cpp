#include "mechanics/elastic_response.hpp"
#include "mechanics/reactions.hpp"
#include "mechanics/support.hpp"
#include "mechanics/tangent_solver.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/statics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace incise {
namespace {

constexpr int kMaxPerLoadStep = 20;
constexpr int kMaxContactChanges =
    8;  // Newton steps per load step that may raise the energy because they change the contact with a support
constexpr int kMaxHalvings = 7;  // of a Newton step in the line search
constexpr double kLeastLoadStep = 1.0 / 64.0;
constexpr double kGoodDecrease = 0.7;  // of the residual: accepted without evaluating the energy
constexpr double kArmijo = 1e-4;
constexpr double kIntermediateTolerance = 1e-2;  // equilibrium of an intermediate load step need not be exact

// Tolerances of conjugate gradients, relative to the right side. The first system of a load step, which carries the
// held vertices, need only be as accurate as the linear response. Later tolerances follow the last decrease of the
// residual (Eisenstat and Walker 1996, choice 2 with exponent 2), so convergence stays quadratic, but are no tighter
// than the final tolerance requires.
constexpr double kCarryTolerance = 1e-3;
constexpr double kLoosestTolerance = 0.03;
constexpr double kForcing = 0.9;
constexpr double kFinalShare = 0.3;  // of the required residual
constexpr int kMaxCgIterations = 4000;

/// Newton's method for one model. Changes the state and the result; everything else is scratch.
class Equilibrium {
 public:
  Equilibrium(const TissueModel& model, const StaticSettings& settings, Workers& workers, Monitor& monitor,
              StaticResult& result)
      : model_(model),
        settings_(settings),
        workers_(workers),
        monitor_(monitor),
        result_(result),
        state_(result.state),
        matrix_(model.pattern),
        solver_(model, settings.solver, kMaxCgIterations),
        free_(free_axes(model, result.state)),
        forces_(free_.size()),
        right_(free_.size()),
        step_(free_.size()),
        jump_(free_.size()),
        load_(model.dead_load_mn),
        out_of_balance_(free_.size(), Vec3::Zero()),
        loose_(free_.size(), 0) {
    for (std::size_t v = 0; v < loose_.size(); ++v) loose_[v] = free_[v].isZero(0.0) ? 1 : 0;
  }

  Outcome run() {
    start_positions_ = state_.positions;
    out_of_balance_ = assemble();
    double done = 0.0;
    double size = settings_.first_load_fraction;
    while (done < 1.0) {
      const TissueState before = state_;
      const double target = std::min(1.0, done + size);
      const Outcome end = advance_to(done, target);
      if (end == Outcome::Cancelled) return end;
      if (end == Outcome::Success) {
        done = target;
        ++result_.load_steps;
        size = std::min(2.0 * size, 1.0 - done);
        report_progress(done);
        continue;
      }
      if (size <= kLeastLoadStep || result_.iterations >= settings_.max_newton_iterations) return Outcome::NotConverged;
      state_ = before;
      size *= 0.5;
    }
    // Smaller load steps would end in the same equilibrium: with these laws the strain itself, not the path to it,
    // inverts a sliver.
    return count_inverted() > 0 ? Outcome::ElementInverted : Outcome::Success;
  }

  [[nodiscard]] std::size_t count_inverted() const {
    std::size_t count = 0;
    for (std::size_t tet = 0; tet < model_.mesh.tets.size(); ++tet) {
      if (state_.is_live[tet] != 0 && !(deformation_gradient(model_, state_.positions, tet).determinant() > 0.0))
        ++count;
    }
    return count;
  }
  /// Returns the chosen solver and the reason, for a person.
  [[nodiscard]] std::string explanation() const {
    return fmt::format(
        "Newton with the exact tangent ({} of {} steps with the projected one, where the exact one was not positive "
        "definite), {}",
        projected_, result_.iterations, solver_.explanation());
  }
  [[nodiscard]] int linear_iterations() const { return solver_.cg_iterations(); }

 private:
  /// Reports progress that never decreases, even if a load step is repeated at half its size.
  void report_progress(double fraction) {
    progress_ = std::max(progress_, std::min(fraction, 1.0));
    monitor_.progress("stretching", progress_);
  }

  /// Reports the residual of one iteration; progress within a load step is logarithmic, from 1 to the tolerance.
  void report_iteration(double done, double fraction, double tolerance) {
    const double share = std::clamp(std::log(result_.relative_residual) / std::log(tolerance), 0.0, 1.0);
    report_progress(done + share * (fraction - done));
    monitor_.message(Severity::Detail,
                     fmt::format("Newton iteration {} at {:.0f} % of the load: relative residual {:.2e}",
                                 result_.iterations, 100.0 * fraction, result_.relative_residual));
  }

  /// Sets the loads at a load fraction: the imbalance at the start is cancelled at 0 and fully present at 1.
  void set_load(double fraction) {
    for (std::size_t v = 0; v < load_.size(); ++v) {
      load_[v] = model_.dead_load_mn[v] - (1.0 - fraction) * out_of_balance_[v];
    }
  }

  /// Returns the sum of all forces at the current positions; with `tangent` also fills matrix_.
  const Points& assemble(std::optional<Tangent> tangent = {}) {
    forces_ = load_;
    BlockMatrix* stiffness = tangent ? &matrix_ : nullptr;
    if (stiffness != nullptr) std::fill(matrix_.values.begin(), matrix_.values.end(), 0.0);
    add_elastic_response(model_, state_, forces_, stiffness, workers_, tangent.value_or(Tangent::FrozenRotations));
    add_support_response(model_, state_, forces_, stiffness);
    return forces_;
  }

  [[nodiscard]] double residual() const { return free_norm(forces_, free_); }

  /// Returns the scale of the residual: the largest of reactions, loads, and a force too small to deform the body.
  [[nodiscard]] double scale() const {
    double reactions = 0.0;
    for (std::size_t v = 0; v < forces_.size(); ++v) {
      for (int i = 0; i < 3; ++i) {
        if (model_.is_fixed[v][static_cast<std::size_t>(i)]) reactions += forces_[v][i] * forces_[v][i];
      }
    }
    return std::max({std::sqrt(reactions), free_norm(load_, free_), negligible_force_mn(model_)});
  }

  [[nodiscard]] double potential() const {
    double work = 0.0;
    for (std::size_t v = 0; v < load_.size(); ++v) work += load_[v].dot(state_.positions[v] - start_positions_[v]);
    return elastic_energy_uj(model_, state_) + support_energy_uj(model_, state_) - work;
  }

  /// Finds the distance by which held axes must still move; zero elsewhere. @returns whether any must.
  bool find_jump(double fraction) {
    bool is_any = false;
    for (std::size_t v = 0; v < jump_.size(); ++v) {
      for (int i = 0; i < 3; ++i) {
        jump_[v][i] = 0.0;
        if (!model_.is_fixed[v][static_cast<std::size_t>(i)]) continue;
        const double last = model_.mesh.vertices[v][i] + model_.prescribed_displacement_mm[v][i];
        const double first = start_positions_[v][i];
        jump_[v][i] = (fraction < 1.0 ? first + fraction * (last - first) : last) - state_.positions[v][i];
        is_any = is_any || jump_[v][i] != 0.0;
      }
    }
    return is_any;
  }

  /// Runs Newton's method at a fixed load fraction. The first step moves the held vertices to their places, and the
  /// tissue with them by the linear response: moving the boundary alone would crush its first row of tets.
  Outcome advance_to(double done, double fraction) {
    set_load(fraction);
    const double tolerance =
        fraction < 1.0 ? std::max(kIntermediateTolerance, settings_.relative_tolerance) : settings_.relative_tolerance;
    bool must_jump = find_jump(fraction);
    contact_changes_ = 0;
    double before = 0.0;  // residual of the previous iteration; 0: none
    for (int i = 0; i < kMaxPerLoadStep; ++i) {
      if (monitor_.is_cancelled()) return Outcome::Cancelled;
      assemble(Tangent::Exact);
      const double now = residual();
      if (!std::isfinite(now)) return Outcome::NotConverged;
      if (!must_jump) {
        result_.relative_residual = now / scale();
        result_.residual_history.push_back(result_.relative_residual);
        report_iteration(done, fraction, tolerance);
        if (result_.relative_residual <= tolerance) return Outcome::Success;
      }
      if (result_.iterations >= settings_.max_newton_iterations) return Outcome::NotConverged;
      const double linear_tolerance =
          must_jump ? kCarryTolerance : forcing(now, before, kFinalShare * tolerance * scale());
      if (!find_step(must_jump, linear_tolerance)) return Outcome::NotConverged;
      before = must_jump ? 0.0 : now;
      ++result_.iterations;
      if (must_jump) {
        for (std::size_t v = 0; v < step_.size(); ++v) state_.positions[v] += step_[v] + jump_[v];
        must_jump = false;
      } else if (!search_along_step(now)) {
        return Outcome::NotConverged;
      }
    }
    return Outcome::NotConverged;
  }

  /// Returns the tolerance of the next linear system, given the current, the previous and the required residual.
  static double forcing(double now, double before, double enough) {
    const double ratio = before > 0.0 ? now / before : 1.0;
    return std::clamp(kForcing * ratio * ratio, std::min(enough / now, kLoosestTolerance), kLoosestTolerance);
  }

  /// Solves for step_ with the exact tangent, or with the projected one if that is not positive definite.
  bool find_step(bool must_jump, double tolerance) {
    for (const Tangent tangent : {Tangent::Exact, Tangent::Projected}) {
      if (tangent == Tangent::Projected) {
        assemble(tangent);
        ++projected_;
      }
      right_ = forces_;
      if (must_jump) {
        multiply(matrix_, jump_, step_, workers_);
        for (std::size_t v = 0; v < right_.size(); ++v) right_[v] -= step_[v];
      }
      hold_constrained(model_, matrix_, right_, loose_);
      const TangentSolver::End end = solver_.solve(matrix_, right_, step_, tolerance, workers_);
      if (end == TangentSolver::End::Solved) return true;
      if (end == TangentSolver::End::NotConverged) return false;
    }
    return false;
  }

  bool search_along_step(double before) {
    const Points base = state_.positions;
    const std::vector<Mat3> base_rotations = state_.rotations;
    double slope = 0.0;  // of the potential along the step
    for (std::size_t v = 0; v < step_.size(); ++v) slope -= right_[v].dot(step_[v]);
    const double base_potential = potential();
    const std::vector<std::uint8_t> base_contacts = support_contacts(model_, state_);
    double length = 1.0;
    for (int i = 0; i <= kMaxHalvings; ++i, length *= 0.5) {
      for (std::size_t v = 0; v < base.size(); ++v) state_.positions[v] = base[v] + length * step_[v];
      assemble();
      if (residual() <= kGoodDecrease * before) return true;
      if (potential() <= base_potential + kArmijo * length * slope) return true;
      // Tissue that falls onto a support overshoots, and the next step, which knows the contacts, corrects it.
      // Approaching each new contact in turn would take far longer.
      if (i == 0 && contact_changes_ < kMaxContactChanges && support_contacts(model_, state_) != base_contacts) {
        ++contact_changes_;
        return true;
      }
    }
    state_.positions = base;
    state_.rotations = base_rotations;
    return false;
  }

  const TissueModel& model_;
  const StaticSettings& settings_;
  Workers& workers_;
  Monitor& monitor_;
  StaticResult& result_;
  TissueState& state_;
  BlockMatrix matrix_;
  TangentSolver solver_;
  Points free_;  // 1 along axes that may move, 0 along held ones and at vertices without a live tet
  Points forces_, right_, step_, jump_, load_, out_of_balance_, start_positions_;
  std::vector<std::uint8_t> loose_;  // flags vertices without a free axis, including those of carved tets only
  double progress_ = 0.0;
  int projected_ = 0;
  int contact_changes_ = 0;
};

void check(const StaticSettings& settings) {
  INCISE_REQUIRE(settings.relative_tolerance > 0.0 && settings.relative_tolerance < 1.0,
                 fmt::format("expected relative_tolerance in (0, 1), found {}", settings.relative_tolerance));
  INCISE_REQUIRE(settings.max_newton_iterations > 0,
                 fmt::format("expected at least 1 Newton iteration, found {}", settings.max_newton_iterations));
  INCISE_REQUIRE(settings.first_load_fraction > 0.0 && settings.first_load_fraction <= 1.0,
                 fmt::format("expected first_load_fraction in (0, 1], found {}", settings.first_load_fraction));
}

/// Warns about each support into which tissue has sunk deeper than the support's stiffness is meant to allow.
void warn_of_penetration(const TissueModel& model, const TissueState& state, Monitor& monitor) {
  for (const SupportPlane& support : model.supports) {
    const double depth = penetration_mm(support, state);
    if (!(depth > kPenetrationAtModulusMm)) continue;
    monitor.message(Severity::Warning,
                    fmt::format("tissue lies up to {:.3g} mm inside the support specimen.constraints[{}], more than {:g} mm: "
                                "it is pressed harder than its Young's modulus there",
                                depth, support.constraint, kPenetrationAtModulusMm));
  }
}

}  // namespace

StaticResult solve_static(const TissueModel& model, const StaticSettings& settings, Workers& workers, Monitor& monitor,
                          const TissueState* start) {
  check(settings);
  const auto began = std::chrono::steady_clock::now();
  StaticResult result;
  result.state = start != nullptr ? *start : rest_state(model);
  Equilibrium equilibrium(model, settings, workers, monitor, result);
  result.outcome = equilibrium.run();

  result.inverted_tets = equilibrium.count_inverted();
  result.reactions_mn = reactions(model, result.state, workers);
  result.penetration_mm = support_penetration_mm(model, result.state);
  warn_of_penetration(model, result.state, monitor);
  for (std::size_t v = 0; v < result.state.positions.size(); ++v) {
    const double length = (result.state.positions[v] - model.mesh.vertices[v]).norm();
    result.max_displacement_mm = std::max(result.max_displacement_mm, length);
  }
  result.solver = equilibrium.explanation();
  result.linear_iterations = equilibrium.linear_iterations();
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

std::string explain_stretch(const StaticResult& stretched) {
  if (stretched.outcome == Outcome::Success) return "";
  if (stretched.outcome == Outcome::Cancelled) return "stopped: the stretch was interrupted";
  const std::string found =
      stretched.outcome == Outcome::ElementInverted
          ? fmt::format(
                "the tissue came to rest, but {} of its tets turned inside out: the tissue is stretched farther than "
                "the mesh can follow",
                stretched.inverted_tets)
          : fmt::format("no equilibrium of the held tissue was found in {} iterations", stretched.iterations);
  return fmt::format(
      "stopped: {}. A smaller displacement_mm, wider held regions (specimen.constraints) or a finer mesh may help",
      found);
}

}  // namespace incise
