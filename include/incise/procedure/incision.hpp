#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/core/workers.hpp>
#include <incise/cutting/carving.hpp>
#include <incise/cutting/tool_program.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/mechanics/tissue.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

struct IncisionSettings {
  CutSettings cut;
  Tool tool;
  Vec3 approach = -Vec3::UnitZ();     ///< unit; the direction in which camera and surgeon look
  double midline_layer_mm = 2.5;      ///< the mid-line is that of the kerf down to this depth below the surface, > 0
  int frames = 0;                     ///< moments to keep for pictures, evenly spaced over the cut; 0: none
};

/// The tissue at one moment of the cut.
struct CutFrame {
  double time_s = 0.0;
  ToolPose tool;
  bool is_tool_in = true;
  Points positions;                   ///< N x 3, mm
  std::vector<std::uint8_t> is_live;  ///< per tet
};

/// One line of the log of a cut.
struct CutStepLog {
  double time_s = 0.0;
  int iterations = 0;                 ///< of the linear solver
  std::size_t tets_in_contact = 0;
  std::size_t removed = 0;
  std::size_t slipped = 0;            ///< bonds that slipped
  Vec3 tool_force_mn = Vec3::Zero();  ///< of the tissue on the tool
  Vec3 tool_torque_mn_mm = Vec3::Zero();  ///< of the tissue on the tool, about its tip
};

/// A simulated incision, however it ended.
struct IncisionResult {
  /// Success: the cut was carried out, and a ring closed. OpenLoop, NotConverged (positions became non-finite) or Cancelled
  /// otherwise. The margin is not judged here: see evaluation.
  Outcome outcome = Outcome::NotConverged;
  std::optional<bool> is_closed_loop;    ///< absent for an open cut
  std::optional<double> gap_mm;          ///< ring that stayed open: width of the widest uncut bridge; absent: closed, or no kerf
  double gap_deg = 0.0;                  ///< ring that stayed open: largest angle without kerf
  double kerf_width_mm = 0.0;            ///< mean, across the mid-line, stretched tissue before the cut
  std::optional<Contour> centerline;     ///< mid-line of the kerf, on the surface, stretched tissue before the cut, mm
  std::optional<Contour> inner_edge;     ///< border of the tissue inside the ring, tool out, tissue still stretched, mm
  Contour final_tumor_edge;              ///< where the tumour edge lies then, mm
  CutRecord record;
  CutState final_state;                  ///< tool out, tissue still stretched
  std::vector<CutFrame> frames;
  std::vector<CutStepLog> steps;
  std::size_t solver_iterations = 0;     ///< sum over all steps
  std::size_t unconverged_steps = 0;     ///< steps whose linear solve reached its limit
  std::size_t held_back_vertices = 0;    ///< vertex steps cut to CutSettings::max_step_mm
  std::size_t inverted_tets = 0;         ///< live tets of negative volume at the end
  std::size_t slipped_bonds = 0;         ///< slips, summed over all steps
  double peak_tool_force_mn = 0.0;
  double peak_tool_torque_mn_mm = 0.0;   ///< about the tool's tip
  double wall_s = 0.0;
};

/// Simulates an incision: tool program, cut, tool out, relaxation, and the contours that are measured.
/// @param stretched  equilibrium of the clamped and stretched tissue.
/// @param path       frame sim_stretched, waypoints on the surface; its tumour edge is carried along with the tissue.
/// Throws InvalidArgument for settings or a path that cannot be used (the list of violations).
[[nodiscard]] IncisionResult simulate_incision(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                                               const IncisionSettings& settings, Workers& workers, Monitor& monitor);

/// Skin of the live tets at given positions, with all N vertices kept in order.
[[nodiscard]] TriMesh skin_of(const TetMesh& mesh, std::span<const Vec3> positions, std::span<const std::uint8_t> is_live = {});

}  // namespace incise
