#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/core/workers.hpp>
#include <incise/cutting/carving.hpp>
#include <incise/cutting/incision_progress.hpp>
#include <incise/cutting/kerf_measures.hpp>
#include <incise/cutting/tool_program.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/mechanics/tissue.hpp>

#include <optional>
#include <vector>

namespace incise {

/// Settings of an incision.
struct IncisionSettings {
  CutSettings cut;
  Tool tool;
  Vec3 approach = -Vec3::UnitZ();  ///< unit; the direction in which camera and surgeon look
  double midline_layer_mm = 2.5;   ///< depth below the surface down to which the kerf counts for the mid-line, > 0
  std::vector<double> layer_depths_mm{
      1.0, 2.5, 4.0, 5.0};  ///< middles of the layers, below the surface; each >= 0.5, ascending
  TriMesh tumor_surface;    ///< closed, stretched tissue before the cut, mm; without triangles: not known
  /// Time from the stretch to the cut, >= 0; only for viscous tissue. Absent: the tissue has relaxed.
  std::optional<double> time_since_stretch_s;
  int frames = 0;           ///< frames to keep for pictures, evenly spaced over the cut, >= 0; at most one per step
};
inline void describe(Visitor& v, IncisionSettings& s) {
  v("cut", s.cut, "How the tool cuts.");
  v("tool", s.tool, "The instrument.");
  v("approach", s.approach, "The direction in which camera and surgeon look.");
  v("midline_layer_mm", s.midline_layer_mm, "Depth down to which the kerf counts for the mid-line.", kPositive);
  v("layer_depths_mm", s.layer_depths_mm, "Middles of the layers with a mid-line of their own.");
  v("tumor_surface", s.tumor_surface,
    "The tumour's surface, stretched tissue before the cut; without triangles: not known.");
  v({"time_since_stretch_s", "Time from the stretch to the cut; absent: viscous tissue has relaxed.", "s"},
    s.time_since_stretch_s, kNotNegative);
  v("frames", s.frames, "Number of moments to keep for pictures.", kNotNegative);
}

/// Result of a simulated incision, whether or not it succeeded.
struct IncisionResult {
  /// Success: the cut was completed, and a ring closed. Otherwise OpenLoop, NotConverged (positions became non-finite,
  /// or more than 1 % of the steps were not solved to the tolerance) or Cancelled. The margin is judged in evaluation.
  Outcome outcome = Outcome::NotConverged;
  std::optional<bool> is_closed_loop;  ///< absent for an open cut
  std::optional<double>
      gap_mm;                  ///< of a ring that stayed open: width of the widest uncut bridge; otherwise, or if it is
                               ///< not known, absent
  double gap_deg = 0.0;        ///< of a ring that stayed open: largest angle without kerf
  double kerf_width_mm = 0.0;  ///< mean, across the mid-line, stretched tissue before the cut
  std::optional<Contour> centerline;  ///< mid-line of the kerf, on the surface, stretched tissue before the cut, mm
  std::optional<Contour> inner_edge;  ///< edge of the kerf next to the tumour, final configuration, mm; only for a ring
  Contour final_tumor_edge;           ///< the tumour edge in the final configuration, mm
  KerfMeasures kerf;                  ///< body, layers, depth, drag and deep margin
  CutRecord record;
  CutState final_state;  ///< tool out, tissue still stretched
  std::vector<CutFrame> frames;  ///< on the split mesh of final_state; the last one shows that state
  std::vector<CutStepLog> steps;
  std::size_t solver_iterations = 0;   ///< sum over all steps
  bool is_at_rest = false;             ///< the tool is out, and the last step was solved and moved each vertex by less
                                       ///< than 0.001 mm
  std::size_t unconverged_steps = 0;   ///< steps whose linear solve reached its limit
  std::size_t held_back_vertices = 0;  ///< motions of vertices shortened to CutSettings::max_step_mm, over all steps
  std::size_t inverted_tets = 0;       ///< live tets of zero or negative volume at the end
  std::size_t slipped_bonds = 0;       ///< slips, summed over all steps
  double peak_tool_force_mn = 0.0;
  double peak_tool_torque_mn_mm = 0.0;  ///< about the tool's tip
  double wall_s = 0.0;
};
inline void describe(Visitor& v, IncisionResult& r) {
  v("program_outcome", r.outcome, "How the tool's program ended.");
  v("closed_loop", r.is_closed_loop, "Whether the ring closed; absent for an open cut.");
  v("gap_mm", r.gap_mm, "Width of the widest uncut bridge in a ring that stayed open.");
  v("gap_deg", r.gap_deg, "Largest angle without kerf in a ring that stayed open.");
  v("kerf_width_mm", r.kerf_width_mm, "Mean width of the kerf, across the mid-line.");
  v.bulk("centerline", r.centerline, "Mid-line of the kerf, stretched tissue before the cut.");
  v.bulk("inner_edge", r.inner_edge, "Border of the tissue inside the ring, tool out.");
  v.bulk("final_tumor_edge", r.final_tumor_edge, "The tumour's edge, tool out.");
  describe(v, r.kerf);
  v.bulk("record", r.record, "Every tet that was removed.");
  v.bulk("final_state", r.final_state, "State with the tool out, tissue still stretched.");
  v.bulk("frames", r.frames, "Moments kept for pictures.");
  v.bulk("steps", r.steps, "The log, step by step.");
  v.derived("removed_tets", r.record.removals.size(), "Number of removed tets.");
  v.derived("removed_volume_mm3", r.record.removed_volume_mm3(), "Volume of these tets at rest.");
  v.derived("steps", r.steps.size(), "Number of steps.");
  v.derived("ms_per_step", r.steps.empty() ? 0.0 : 1e3 * r.wall_s / static_cast<double>(r.steps.size()),
            "Wall time per step.");
  v("solver_iterations", r.solver_iterations, "Iterations of the linear solver, summed over all steps.");
  v("at_rest", r.is_at_rest, "Whether nothing moved any more in the last step.");
  v("unconverged_steps", r.unconverged_steps, "Steps whose linear solve reached its limit.");
  v("held_back_vertices", r.held_back_vertices, "Number of motions of vertices that were cut short, over all steps.");
  v("inverted_tets", r.inverted_tets, "Live tets of negative volume at the end.");
  v("slipped_bonds", r.slipped_bonds, "Number of slips, summed over all steps.");
  v("peak_tool_force_mn", r.peak_tool_force_mn, "Greatest force on the tool.");
  v("peak_tool_torque_mn_mm", r.peak_tool_torque_mn_mm, "Greatest torque about the tool's tip.");
  v("wall_s", r.wall_s, "Time that the simulation took.");
}

/// Returns an incision that has not begun: the tool at the first entry point, the tissue stretched.
/// @param stretched  equilibrium of the clamped and stretched tissue.
/// @param path       frame sim_stretched, waypoints on the surface.
/// @throws InvalidArgument listing the violations of the settings, or for a path that ToolProgram does not accept.
[[nodiscard]] IncisionProgress begin_incision(const TissueModel& model, const TissueState& stretched,
                                              const ToolPath& path, const IncisionSettings& settings);

/// Continues an incision to its end: runs the rest of the tool program, takes the tool out, lets the tissue come to
/// rest, and measures the cut.
/// @param path      as for begin_incision; its tumour edge, if any, moves with the tissue.
/// @param progress  of this model, stretched tissue, path and settings: from begin_incision, or passed to `keep`.
/// @param keep      receives the progress at each renewal step. With it, a cancelled incision stops at the next renewal
///                  step (at most 20 steps later), so no computed step is lost; without it, at once.
/// @throws InvalidArgument, before it cuts, as begin_incision; if the progress is of another mesh; for a tumour edge
///         more than 0.5 mm off the tissue; for a tumour surface that encloses no volume.
[[nodiscard]] IncisionResult continue_incision(const TissueModel& model, const TissueState& stretched,
                                               const ToolPath& path, const IncisionSettings& settings,
                                               IncisionProgress progress, Workers& workers, Monitor& monitor,
                                               const ProgressKeeper& keep = {});

/// Simulates an incision from beginning to end: begin_incision, then continue_incision.
[[nodiscard]] IncisionResult simulate_incision(const TissueModel& model, const TissueState& stretched,
                                               const ToolPath& path, const IncisionSettings& settings, Workers& workers,
                                               Monitor& monitor);

/// Returns the skin of the live tets, with all N vertices in their order.
/// @param positions  of the mesh's vertices, N x 3, mm.
/// @param is_live    one flag per tet; empty: all tets are live.
[[nodiscard]] TriMesh skin_of(const TetMesh& mesh, std::span<const Vec3> positions,
                              std::span<const std::uint8_t> is_live = {});

}  // namespace incise
