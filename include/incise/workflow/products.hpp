#pragma once

#include <incise/core/verdict.hpp>
#include <incise/cutting/incision.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/planning/compensation.hpp>
#include <incise/planning/converging_compensation.hpp>
#include <incise/workflow/case.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// The mesh of a specimen, made around the planned cut.
struct MeshProduct {
  MeshingResult meshing;
  Contour planned_cut_rest;  ///< where the planned cut lies in the unstretched body, mm; empty when the mesh was given
};
inline void describe(Visitor& v, MeshProduct& m) {
  v("meshing", m.meshing, "The mesh and how it was made.");
  v("planned_cut_rest", m.planned_cut_rest, "Where the planned cut lies in the unstretched body.");
}

/// Errors of the mid-line in one layer against the lateral margin, as seen along the approach; absent: no mid-line there.
struct LayerErrors {
  std::optional<Summary> signed_error_mm;
  std::optional<Summary> abs_error_mm;
};
inline void describe(Visitor& v, LayerErrors& e) {
  v({"signed_error_mm", "Of the mid-line there against the lateral margin.", "mm"}, e.signed_error_mm);
  v({"abs_error_mm", "Its absolute value.", "mm"}, e.abs_error_mm);
}

/// One simulated incision and what it is worth.
struct SimulatedCut {
  IncisionResult incision;
  Evaluation centerline;  ///< mid-line against the lateral margin, stretched tissue before the cut
  Evaluation inner_edge;  ///< inner edge against margin less electrode radius, tool out
  std::vector<LayerErrors> layers;  ///< one for each of incision.kerf.layers
  Outcome outcome = Outcome::NotConverged;  ///< of incision and margin together
  std::size_t tets = 0;   ///< of the mesh before the cut
  double thermal_half_width_mm = 0.0;  ///< how far beside the real electrode heat damages tissue, where the path is slowest and shallowest
  /// Of an open cut beside a tumour whose edge is known: least distance of its mid-line from the edge, seen along the
  /// approach, at any depth, mm; below 0: within the tumour.
  std::optional<double> line_to_edge_mm;
  /// Tissue left unheated beside the tumour edge, mm: least distance of the mid-line from it less the half width; below
  /// 0: heat reaches the edge. Absent without a mid-line, and for an open cut without a tumour edge.
  std::optional<double> thermal_margin_mm;
  Verdict verdict;  ///< what is held against the path that was cut: verdict_of_cut, and what was known of mesh and path before it
};
void describe(Visitor& v, SimulatedCut& cut);

/// How the path was corrected.
struct Correction {
  CompensationMethod method = CompensationMethod::Default;
  /// The corrected path. Errors per waypoint are those of the cut as planned (method profile: those that were
  /// expected), moves those from the path that it followed.
  Compensation moves;
  std::optional<double> floor_mm;                 ///< see mesh_floor_mm; the default method only
  std::optional<ConvergedCompensation> iteration;  ///< pass by pass; the default method only
};
inline void describe(Visitor& v, Correction& c) {
  v("method", c.method, "How the path was corrected.");
  v("floor_mm", c.floor_mm, "Mean |error| that the mesh alone leaves.");
  describe(v, c.moves);
  v.bulk("iteration", c.iteration, "Pass by pass.");
  if (c.iteration && v.is_summary()) describe(v, *c.iteration);
}

}  // namespace incise
