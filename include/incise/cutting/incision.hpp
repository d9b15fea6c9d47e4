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

struct IncisionSettings {
  CutSettings cut;
  Tool tool;
  Vec3 approach = -Vec3::UnitZ();  ///< unit; the direction in which camera and surgeon look
  double midline_layer_mm = 2.5;   ///< the mid-line is that of the kerf down to this depth below the surface, > 0
  std::vector<double> layer_depths_mm{
      1.0, 2.5, 4.0, 5.0};  ///< middles of the layers with a mid-line of their own; each >= 0.5, ascending
  TriMesh tumor_surface;    ///< closed, stretched tissue before the cut, mm; without triangles: not known
  /// Between the stretch and the cut, >= 0; for viscous tissue alone. Absent: it has relaxed.
  std::optional<double> time_since_stretch_s;
  int frames = 0;           ///< moments to keep for pictures, evenly spaced over the cut; 0: none
};
inline void describe(Visitor& v, IncisionSettings& s) {
  v("cut", s.cut, "How the tool cuts.");
  v("tool", s.tool, "The instrument.");
  v("approach", s.approach, "The direction in which camera and surgeon look.");
  v("midline_layer_mm", s.midline_layer_mm, "The mid-line is that of the kerf down to this depth.", kPositive);
  v("layer_depths_mm", s.layer_depths_mm, "Middles of the layers with a mid-line of their own.");
  v("tumor_surface", s.tumor_surface, "Stretched tissue before the cut; without triangles: not known.");
  v({"time_since_stretch_s", "Between the stretch and the cut; absent: viscous tissue has relaxed.", "s"},
    s.time_since_stretch_s, kNotNegative);
  v("frames", s.frames, "Moments to keep for pictures.", kNotNegative);
}

/// A simulated incision, however it ended.
struct IncisionResult {
  /// Success: the cut was carried out, and a ring closed. OpenLoop, NotConverged (positions became non-finite) or
  /// Cancelled otherwise. The margin is not judged here: see evaluation.
  Outcome outcome = Outcome::NotConverged;
  std::optional<bool> is_closed_loop;  ///< absent for an open cut
  std::optional<double>
      gap_mm;                  ///< ring that stayed open: width of the widest uncut bridge; absent: closed, or no kerf
  double gap_deg = 0.0;        ///< ring that stayed open: largest angle without kerf
  double kerf_width_mm = 0.0;  ///< mean, across the mid-line, stretched tissue before the cut
  std::optional<Contour> centerline;  ///< mid-line of the kerf, on the surface, stretched tissue before the cut, mm
  std::optional<Contour> inner_edge;  ///< border of the tissue inside the ring, tool out, tissue still stretched, mm
  Contour final_tumor_edge;           ///< where the tumour edge lies then, mm
  KerfMeasures kerf;                  ///< body, layers, depth, drag and deep margin
  CutRecord record;
  CutState final_state;  ///< tool out, tissue still stretched
  std::vector<CutFrame> frames;  ///< on the split mesh of final_state
  std::vector<CutStepLog> steps;
  std::size_t solver_iterations = 0;   ///< sum over all steps
  bool is_at_rest = false;             ///< no vertex moved by more than 0.001 mm in the last step, the tool out
  std::size_t unconverged_steps = 0;   ///< steps whose linear solve reached its limit
  std::size_t held_back_vertices = 0;  ///< vertex steps cut to CutSettings::max_step_mm
  std::size_t inverted_tets = 0;       ///< live tets of negative volume at the end
  std::size_t slipped_bonds = 0;       ///< slips, summed over all steps
  double peak_tool_force_mn = 0.0;
  double peak_tool_torque_mn_mm = 0.0;  ///< about the tool's tip
  double wall_s = 0.0;
};
inline void describe(Visitor& v, IncisionResult& r) {
  v("program_outcome", r.outcome, "How the tool's program ended.");
  v("closed_loop", r.is_closed_loop, "Whether the ring closed; absent for an open cut.");
  v("gap_mm", r.gap_mm, "Of a ring that stayed open: width of the widest uncut bridge.");
  v("gap_deg", r.gap_deg, "Of a ring that stayed open: largest angle without kerf.");
  v("kerf_width_mm", r.kerf_width_mm, "Mean, across the mid-line.");
  v.bulk("centerline", r.centerline, "Mid-line of the kerf, stretched tissue before the cut.");
  v.bulk("inner_edge", r.inner_edge, "Border of the tissue inside the ring, tool out.");
  v.bulk("final_tumor_edge", r.final_tumor_edge, "The tumour's edge, tool out.");
  describe(v, r.kerf);
  v.bulk("record", r.record, "Every tet that was removed.");
  v.bulk("final_state", r.final_state, "Tool out, tissue still stretched.");
  v.bulk("frames", r.frames, "Kept for pictures.");
  v.bulk("steps", r.steps, "The log, step by step.");
  v.derived("removed_tets", r.record.removals.size(), "How many.");
  v.derived("removed_volume_mm3", r.record.removed_volume_mm3(), "Of these tets at rest.");
  v.derived("steps", r.steps.size(), "How many.");
  v.derived("ms_per_step", r.steps.empty() ? 0.0 : 1e3 * r.wall_s / static_cast<double>(r.steps.size()), "Wall time.");
  v("solver_iterations", r.solver_iterations, "Sum over all steps.");
  v("at_rest", r.is_at_rest, "Whether nothing moved any more in the last step.");
  v("unconverged_steps", r.unconverged_steps, "Steps whose linear solve reached its limit.");
  v("held_back_vertices", r.held_back_vertices, "Vertex steps that were cut short.");
  v("inverted_tets", r.inverted_tets, "Live tets of negative volume at the end.");
  v("slipped_bonds", r.slipped_bonds, "Slips, summed over all steps.");
  v("peak_tool_force_mn", r.peak_tool_force_mn, "Greatest force on the tool.");
  v("peak_tool_torque_mn_mm", r.peak_tool_torque_mn_mm, "Greatest torque about the tool's tip.");
  v("wall_s", r.wall_s, "Time that the simulation took.");
}

/// An incision that has not begun: the tool over the first waypoint, the tissue stretched.
/// @param stretched  equilibrium of the clamped and stretched tissue.
/// @param path       frame sim_stretched, waypoints on the surface.
/// @throws InvalidArgument for settings or a path that cannot be used (the list of violations).
[[nodiscard]] IncisionProgress begin_incision(const TissueModel& model, const TissueState& stretched,
                                              const ToolPath& path, const IncisionSettings& settings);

/// Carries an incision from where it is to its end: tool program, cut, tool out, relaxation, and the contours that are
/// measured.
/// @param path      its tumour edge is carried along with the tissue.
/// @param progress  of this model, stretched tissue, path and settings; it has not begun, or is one that `keep` was
/// shown.
/// @param keep      with it, a monitor that asks to stop is obeyed at the next renewal step (at most 20 steps later),
/// so that nothing
///                  that was computed is lost; without it at once.
/// @throws InvalidArgument as begin_incision, or when the progress is of another mesh.
[[nodiscard]] IncisionResult continue_incision(const TissueModel& model, const TissueState& stretched,
                                               const ToolPath& path, const IncisionSettings& settings,
                                               IncisionProgress progress, Workers& workers, Monitor& monitor,
                                               const ProgressKeeper& keep = {});

/// Simulates an incision from beginning to end: begin_incision, then continue_incision.
[[nodiscard]] IncisionResult simulate_incision(const TissueModel& model, const TissueState& stretched,
                                               const ToolPath& path, const IncisionSettings& settings, Workers& workers,
                                               Monitor& monitor);

/// Skin of the live tets at given positions, with all N vertices kept in order.
[[nodiscard]] TriMesh skin_of(const TetMesh& mesh, std::span<const Vec3> positions,
                              std::span<const std::uint8_t> is_live = {});

}  // namespace incise
