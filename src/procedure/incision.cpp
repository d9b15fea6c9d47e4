#include "kerf.hpp"

#include <incise/core/error.hpp>
#include <incise/procedure/incision.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace incise {
namespace {

constexpr double kRelaxedMm = 1e-3;      // the tissue counts as at rest when no vertex moves farther in a step
constexpr double kSingleTolerance = 1e-2;  // of a step's residual: from here up single precision suffices
constexpr int kMaxRelaxationSteps = 60;  // after the tool is out

void require_valid(const IncisionSettings& settings) {
  std::vector<std::string> violations = validate(settings.cut, 2.0 * radius_mm(settings.tool));
  const std::vector<std::string> tool = validate(settings.tool);
  violations.insert(violations.end(), tool.begin(), tool.end());
  if (!(settings.midline_layer_mm > 0.0)) {
    violations.push_back(fmt::format("midline_layer_mm: found {}, expected above 0 mm", settings.midline_layer_mm));
  }
  if (settings.frames < 0) violations.push_back(fmt::format("frames: found {}, expected 0 or more", settings.frames));
  INCISE_REQUIRE(violations.empty(), fmt::format("{}", fmt::join(violations, "; ")));
}

/// Keeps frames evenly spaced over the cut, the first before it and the last after the tissue came to rest.
class FrameKeeper {
 public:
  FrameKeeper(int frames, double duration_s, std::vector<CutFrame>& kept)
      : frames_(frames), duration_s_(duration_s), kept_(kept) {}

  void offer(const CutState& state, bool is_tool_in) {
    const double due = duration_s_ * static_cast<double>(kept_.size()) / std::max(1, frames_ - 1);
    if (static_cast<int>(kept_.size()) < frames_ - 1 && state.time_s >= due - 1e-9) keep(state, is_tool_in);
  }
  void keep_last(const CutState& state) {
    if (frames_ > 0) keep(state, false);
  }

 private:
  void keep(const CutState& state, bool is_tool_in) {
    kept_.push_back({state.time_s, state.tool, is_tool_in, state.tissue.positions, state.tissue.is_live});
  }
  int frames_;
  double duration_s_;
  std::vector<CutFrame>& kept_;
};

void log_step(const CutState& state, const CutStepReport& report, IncisionResult& result) {
  result.steps.push_back({state.time_s, report.solve.iterations, report.tets_in_contact, report.removed + report.loose_removed,
                          report.slipped, report.tool_force_mn, report.tool_torque_mn_mm});
  result.solver_iterations += static_cast<std::size_t>(report.solve.iterations);
  result.unconverged_steps += report.solve.converged ? 0 : 1;
  result.held_back_vertices += report.held_back_vertices;
  result.slipped_bonds += report.slipped;
  result.peak_tool_torque_mn_mm = std::max(result.peak_tool_torque_mn_mm, report.tool_torque_mn_mm.norm());
  result.peak_tool_force_mn = std::max(result.peak_tool_force_mn, report.tool_force_mn.norm());
}

/// Runs the tool program. @returns Success when it was carried out, else how it ended.
Outcome run_program(const TissueModel& model, const ToolProgram& program, const IncisionSettings& settings, CutState& state,
                    CutWorkspace& workspace, FrameKeeper& frames, Workers& workers, Monitor& monitor, IncisionResult& result) {
  const double step_s = settings.cut.step_s();
  frames.offer(state, true);
  while (state.time_s < program.duration_s() - 1e-9) {
    if (monitor.is_cancelled()) return Outcome::Cancelled;
    const double dt = std::min(step_s, program.duration_s() - state.time_s);
    const CutStepReport report = advance(model, settings.cut, settings.tool, state, workspace,
                                         program.pose_at(state.time_s + dt), dt, workers);
    log_step(state, report, result);
    if (!report.is_finite) return Outcome::NotConverged;
    frames.offer(state, true);
    monitor.progress("cutting", state.time_s / program.duration_s());
  }
  return Outcome::Success;
}

/// Takes the tool out and lets the tissue come to rest.
Outcome relax(const TissueModel& model, const IncisionSettings& settings, CutState& state, CutWorkspace& workspace,
              Workers& workers, const Monitor& monitor, IncisionResult& result) {
  for (int i = 0; i < kMaxRelaxationSteps; ++i) {
    if (monitor.is_cancelled()) return Outcome::Cancelled;
    const CutStepReport report =
        advance(model, settings.cut, settings.tool, state, workspace, std::nullopt, settings.cut.step_s(), workers);
    log_step(state, report, result);
    if (!report.is_finite) return Outcome::NotConverged;
    if (report.max_step_mm < kRelaxedMm) return Outcome::Success;
  }
  return Outcome::Success;
}

std::size_t count_inverted(const TissueModel& model, const TissueState& tissue) {
  std::size_t count = 0;
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    if (tissue.is_live[tet] == 0) continue;
    const Tet& t = model.mesh.tets[tet];
    const auto& x = tissue.positions;
    if (signed_volume(x[t[0].index()], x[t[1].index()], x[t[2].index()], x[t[3].index()]) <= 0.0) ++count;
  }
  return count;
}

}  // namespace

IncisionResult simulate_incision(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                                 const IncisionSettings& settings, Workers& workers, Monitor& monitor) {
  require_valid(settings);
  const auto start = std::chrono::steady_clock::now();
  const ToolProgram program(path, settings.cut, settings.tool);
  IncisionResult result;
  CutState state = begin_cut(model, stretched, program.pose_at(0.0));
  CutWorkspace workspace(model, stretched.positions,
                         settings.cut.residual_tolerance >= kSingleTolerance ? Precision::Single : Precision::Double);
  FrameKeeper frames(settings.frames, program.duration_s(), result.frames);

  result.outcome = run_program(model, program, settings, state, workspace, frames, workers, monitor, result);
  if (result.outcome == Outcome::Success) {
    result.outcome = relax(model, settings, state, workspace, workers, monitor, result);
  }
  frames.keep_last(state);
  result.record = state.record;
  result.inverted_tets = count_inverted(model, state.tissue);
  result.final_state = std::move(state);
  measure_kerf(model, stretched, path, settings, result);
  if (result.outcome == Outcome::Success && result.is_closed_loop && !*result.is_closed_loop) {
    result.outcome = Outcome::OpenLoop;
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

TriMesh skin_of(const TetMesh& mesh, std::span<const Vec3> positions, std::span<const std::uint8_t> is_live) {
  TriMesh skin;
  skin.vertices.assign(positions.begin(), positions.end());
  for (const BoundaryFace& face : boundary_faces(mesh, is_live)) skin.triangles.push_back(face.corners);
  return skin;
}

}  // namespace incise
