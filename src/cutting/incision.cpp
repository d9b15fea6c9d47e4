#include "kerf.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/cut_invariants.hpp>
#include <incise/cutting/incision.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kRelaxedMm = 1e-3;         // the tissue counts as at rest if every vertex moves less in a step
constexpr double kSingleTolerance = 5e-2;   // of a step's residual: from here up single precision suffices
constexpr double kSingleBulkRatio = 500.0;  // λ/μ up to which it does
constexpr double kUnsolvedShare = 0.01;     // of the steps: with more, the cut did not converge
constexpr double kTimeRoundingS = 1e-9;     // the program has ended when less than this remains
constexpr double kLeastStepShare = 0.01;  // of a step: a shorter remainder of the program joins the step before it
constexpr int kMaxRelaxationSteps = 60;   // after the tool is out
constexpr int kStepsToTellFrom = 20;      // the duration of a run is estimated from so many steps

void require_valid(const IncisionSettings& settings) {
  std::vector<Problem> violations = validate(settings.cut, 2.0 * radius_mm(settings.tool));
  const std::vector<Problem> tool = validate(settings.tool);
  violations.insert(violations.end(), tool.begin(), tool.end());
  if (!(settings.midline_layer_mm > 0.0)) {
    violations.push_back({"midline_layer_mm", fmt::format("{}", settings.midline_layer_mm), "above 0 mm"});
  }
  for (std::size_t i = 0; i < settings.layer_depths_mm.size(); ++i) {
    const double depth = settings.layer_depths_mm[i];
    const bool is_ascending = i == 0 || depth > settings.layer_depths_mm[i - 1];
    if (std::isfinite(depth) && depth >= 0.5 * kLayerThicknessMm && is_ascending) continue;
    violations.push_back({fmt::format("layer_depths_mm[{}]", i), fmt::format("{}", depth),
                          fmt::format("{} mm or more, ascending", 0.5 * kLayerThicknessMm)});
  }
  if (settings.time_since_stretch_s && !(*settings.time_since_stretch_s >= 0.0)) {
    violations.push_back({"time_since_stretch_s", fmt::format("{}", *settings.time_since_stretch_s), "0 s or more"});
  }
  if (settings.frames < 0) violations.push_back({"frames", std::to_string(settings.frames), "0 or more"});
  require_none(violations);
}

void keep_frame(IncisionProgress& progress, bool is_tool_in) {
  const CutState& state = progress.state;
  progress.frames.push_back({state.time_s, state.step, state.tool, is_tool_in, state.tissue.positions});
}

/// Keeps a frame if one is due: frames are evenly spaced over the cut, the first before it, the last at the run's end.
void offer_frame(const IncisionSettings& settings, const ToolProgram& program, IncisionProgress& progress) {
  const auto kept = static_cast<int>(progress.frames.size());
  const double due = program.duration_s() * static_cast<double>(kept) / std::max(1, settings.frames - 1);
  if (kept < settings.frames - 1 && progress.state.time_s >= due - kTimeRoundingS) keep_frame(progress, true);
}

CutStepLog log_of(const CutState& state, const CutStepReport& report) {
  return {state.time_s,
          report.solve.iterations,
          report.solve.converged,
          report.tets_in_contact,
          report.removed + report.loose_removed,
          report.held_back_vertices,
          report.slipped,
          report.tool_force_mn,
          report.tool_torque_mn_mm};
}

void require_same_mesh(const TissueModel& model, const CutState& state) {
  const std::size_t vertices = model.mesh.vertices.size() + state.splits.vertices.size();
  const std::size_t tets = model.mesh.tets.size() + state.splits.copies.size();
  INCISE_REQUIRE(state.tissue.positions.size() == vertices && state.dose.size() == tets,
                 fmt::format("expected the progress of a cut of {} vertices and {} tets, found {} and {}", vertices,
                             tets, state.tissue.positions.size(), state.dose.size()));
  const std::string problem = find_problem(model, state);
  INCISE_REQUIRE(problem.empty(), problem);
}

Precision precision_for(const TissueModel& model, const CutSettings& cut) {
  const bool is_soft_in_shear = std::any_of(model.lame.begin(), model.lame.end(), [](const LameParameters& lame) {
    return lame.lambda_kpa > kSingleBulkRatio * lame.mu_kpa;
  });
  return cut.residual_tolerance >= kSingleTolerance && !is_soft_in_shear ? Precision::Single : Precision::Double;
}

/// Advances an incision step by step to the end of its program and then to rest.
class IncisionRun {
 public:
  IncisionRun(const TissueModel& model, const TissueState& stretched, const ToolProgram& program,
              const IncisionSettings& settings, IncisionProgress& progress, Workers& workers, Monitor& monitor,
              const ProgressKeeper& keep)
      : model_(model),
        program_(program),
        settings_(settings),
        progress_(progress),
        workspace_(model, stretched.positions, precision_for(model, settings.cut)),
        workers_(workers),
        monitor_(monitor),
        keep_(keep),
        earlier_wall_s_(progress.wall_s) {}

  /// @returns Success: the program was completed; otherwise Cancelled or NotConverged.
  Outcome run() {
    tell_size();
    while (is_tool_in()) {
      if (is_to_stop()) return Outcome::Cancelled;
      const double dt = next_step_s();
      const CutStepReport report = step(program_.pose_at(state().time_s + dt), dt);
      if (!report.is_finite) return broken_off();
      offer_frame(settings_, program_, progress_);
      monitor_.progress("cutting", std::min(1.0, state().time_s / program_.duration_s()));
    }
    while (progress_.relaxation_steps < kMaxRelaxationSteps) {
      if (is_to_stop()) return Outcome::Cancelled;
      const CutStepReport report = step(std::nullopt, settings_.cut.step_s());
      ++progress_.relaxation_steps;
      if (!report.is_finite) return broken_off();
      is_at_rest_ = report.solve.converged && report.max_step_mm < kRelaxedMm;
      if (is_at_rest_) return Outcome::Success;
    }
    monitor_.message(
        Severity::Warning,
        fmt::format("the tissue is not at rest {} steps after the tool came out: the inner edge may still move",
                    kMaxRelaxationSteps));
    return Outcome::Success;
  }

  /// The tool is still in if the cut was cancelled or broke off before the first step without it.
  void keep_last_frame() {
    if (settings_.frames > 0) keep_frame(progress_, progress_.relaxation_steps == 0);
  }
  [[nodiscard]] bool is_at_rest() const { return is_at_rest_; }

 private:
  [[nodiscard]] CutState& state() { return progress_.state; }
  Outcome broken_off() {
    monitor_.message(Severity::Warning,
                     fmt::format("the cut ends at {:.3f} s, in step {}: positions are no longer finite. Do not use "
                                 "what was cut until then",
                                 state().time_s, progress_.steps.size()));
    return Outcome::NotConverged;
  }
  [[nodiscard]] bool is_tool_in() const {
    return progress_.relaxation_steps == 0 && progress_.state.time_s < program_.duration_s() - kTimeRoundingS;
  }
  [[nodiscard]] double wall_s() const {
    return earlier_wall_s_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// The number of steps that the tool's program still takes.
  [[nodiscard]] int steps_left() const {
    const double left_s = std::max(0.0, program_.duration_s() - progress_.state.time_s);
    return static_cast<int>(std::ceil(left_s / settings_.cut.step_s() - kLeastStepShare));
  }

  /// The duration of the next step. The last step may be shorter, but it is never a sliver left over by rounding, in
  /// which viscosity would hold the tissue in place: the step before it includes the sliver.
  [[nodiscard]] double next_step_s() const {
    const double left_s = program_.duration_s() - progress_.state.time_s;
    const double step_s = settings_.cut.step_s();
    return left_s < (1.0 + kLeastStepShare) * step_s ? left_s : step_s;
  }

  void tell_size() const {
    monitor_.message(
        Severity::Notice,
        fmt::format("cutting {} tets in {} steps, then at most {} more until they are at rest", model_.mesh.tets.size(),
                    steps_left(), kMaxRelaxationSteps - progress_.relaxation_steps));
  }

  /// Reports the estimated duration after kStepsToTellFrom steps.
  void tell_duration() const {
    if (progress_.state.step != first_step_ + kStepsToTellFrom) return;
    const double per_step_s = (wall_s() - earlier_wall_s_) / kStepsToTellFrom;
    monitor_.message(Severity::Notice,
                     fmt::format("cutting takes about {:.0f} s", per_step_s * (kStepsToTellFrom + steps_left())));
  }

  CutStepReport step(const std::optional<ToolPose>& next, double dt) {
    const CutStepReport report =
        advance(model_, settings_.cut, settings_.tool, state(), workspace_, next, dt, workers_);
    progress_.steps.push_back(log_of(state(), report));
    tell_duration();
    return report;
  }

  /// Passes the progress to keep_ at a renewal step. @returns whether to stop here.
  bool is_to_stop() {
    const bool is_cancelled = monitor_.is_cancelled();
    if (!keep_) return is_cancelled;
    if (!is_renewal_step(state())) return false;
    progress_.wall_s = wall_s();
    keep_(progress_, is_cancelled);
    return is_cancelled;
  }

  const TissueModel& model_;
  const ToolProgram& program_;
  const IncisionSettings& settings_;
  IncisionProgress& progress_;
  CutWorkspace workspace_;
  Workers& workers_;
  Monitor& monitor_;
  const ProgressKeeper& keep_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double earlier_wall_s_;
  bool is_at_rest_ = false;
  int first_step_ = progress_.state.step;  // of this run
};

/// Warns if there are fewer frames than requested: each step gives at most one.
void tell_missing_frames(const IncisionSettings& settings, Outcome outcome, const IncisionProgress& progress,
                         Monitor& monitor) {
  const std::size_t kept = progress.frames.size();
  if (outcome != Outcome::Success || kept >= static_cast<std::size_t>(settings.frames)) return;
  monitor.message(
      Severity::Warning,
      fmt::format("{} frames instead of {}: the cut took only {} steps with the tool in, and keeps at most one frame "
                  "per step. A smaller advance_per_step_mm gives more",
                  kept, settings.frames, progress.steps.size() - static_cast<std::size_t>(progress.relaxation_steps)));
}

void sum_up(const std::vector<CutStepLog>& steps, IncisionResult& result) {
  for (const CutStepLog& step : steps) {
    result.solver_iterations += static_cast<std::size_t>(step.iterations);
    result.unconverged_steps += step.converged ? 0 : 1;
    result.held_back_vertices += step.held_back_vertices;
    result.slipped_bonds += step.slipped;
    result.peak_tool_torque_mn_mm = std::max(result.peak_tool_torque_mn_mm, step.tool_torque_mn_mm.norm());
    result.peak_tool_force_mn = std::max(result.peak_tool_force_mn, step.tool_force_mn.norm());
  }
}

/// The next step corrects one that was not solved, but too many of them spoil the cut.
void judge_solves(IncisionResult& result, std::size_t steps, Monitor& monitor) {
  if (result.unconverged_steps == 0) return;
  monitor.message(Severity::Warning,
                  fmt::format("{} of {} steps were not solved to the tolerance", result.unconverged_steps, steps));
  const bool is_too_many = static_cast<double>(result.unconverged_steps) > kUnsolvedShare * static_cast<double>(steps);
  if (result.outcome == Outcome::Success && is_too_many) result.outcome = Outcome::NotConverged;
}

std::size_t count_inverted(const TetMesh& mesh, const TissueState& tissue) {
  std::size_t count = 0;
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (tissue.is_live[tet] == 0) continue;
    const auto [a, b, c, d] = corners_of(tissue.positions, mesh.tets[tet]);
    if (signed_volume(a, b, c, d) <= 0.0) ++count;
  }
  return count;
}

/// Extends a frame to the split mesh at the end of the cut: vertices split off later have their originals' positions.
void complete(CutFrame& frame, const TetMesh& whole, const MeshSplits& splits) {
  for (std::size_t v = frame.positions.size() - whole.vertices.size(); v < splits.vertices.size(); ++v)
    frame.positions.push_back(Vec3(frame.positions[splits.vertices[v].index()]));
}

}  // namespace

IncisionProgress begin_incision(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                                const IncisionSettings& settings) {
  require_valid(settings);
  const ToolProgram program(path, settings.cut, settings.tool);
  IncisionProgress progress;
  progress.state = begin_cut(model, stretched, program.pose_at(0.0));
  remember_deformation(model, progress.state.tissue,
                       settings.time_since_stretch_s.value_or(std::numeric_limits<double>::infinity()));
  offer_frame(settings, program, progress);
  return progress;
}

IncisionResult continue_incision(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                                 const IncisionSettings& settings, IncisionProgress progress, Workers& workers,
                                 Monitor& monitor, const ProgressKeeper& keep) {
  require_valid(settings);
  require_same_mesh(model, progress.state);
  require_measurable(model, stretched, path, settings);
  const auto start = std::chrono::steady_clock::now();
  const double earlier_wall_s = progress.wall_s;
  const ToolProgram program(path, settings.cut, settings.tool);
  IncisionResult result;
  {
    IncisionRun run(model, stretched, program, settings, progress, workers, monitor, keep);
    result.outcome = run.run();
    result.is_at_rest = run.is_at_rest();
    run.keep_last_frame();
    tell_missing_frames(settings, result.outcome, progress, monitor);
  }  // its workspace is large
  sum_up(progress.steps, result);
  judge_solves(result, progress.steps.size(), monitor);
  for (CutFrame& frame : progress.frames) complete(frame, model.mesh, progress.state.splits);
  result.steps = std::move(progress.steps);
  result.frames = std::move(progress.frames);
  result.record = progress.state.record;
  result.inverted_tets = count_inverted(split_mesh(model.mesh, progress.state.splits), progress.state.tissue);
  result.final_state = std::move(progress.state);
  measure_kerf(model, stretched, path, settings, result, workers);
  if (result.outcome == Outcome::Success && result.is_closed_loop && !*result.is_closed_loop) {
    result.outcome = Outcome::OpenLoop;
  }
  result.wall_s = earlier_wall_s + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

IncisionResult simulate_incision(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                                 const IncisionSettings& settings, Workers& workers, Monitor& monitor) {
  return continue_incision(model, stretched, path, settings, begin_incision(model, stretched, path, settings), workers,
                           monitor);
}

TriMesh skin_of(const TetMesh& mesh, std::span<const Vec3> positions, std::span<const std::uint8_t> is_live) {
  TriMesh skin;
  skin.vertices.assign(positions.begin(), positions.end());
  for (const BoundaryFace& face : boundary_faces(mesh, is_live)) skin.triangles.push_back(face.corners);
  return skin;
}

}  // namespace incise
