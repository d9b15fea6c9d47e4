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
#include <vector>

namespace incise {

/// The mesh of a specimen, made around the planned cut.
struct MeshProduct {
  MeshingResult meshing;
  Contour planned_cut_rest;  ///< the planned cut in the unstretched body, mm; empty if the mesh was given
};
inline void describe(Visitor& v, MeshProduct& m) {
  v("meshing", m.meshing, "The mesh and how it was made.");
  v("planned_cut_rest", m.planned_cut_rest, "Where the planned cut lies in the unstretched body.");
}

/// Errors of the mid-line in one layer against the lateral margin, mm, seen along the approach; absent: the layer has
/// no mid-line.
struct LayerErrors {
  std::optional<Summary> signed_error_mm;
  std::optional<Summary> abs_error_mm;
};
inline void describe(Visitor& v, LayerErrors& e) {
  v({"signed_error_mm", "Signed error of the layer's mid-line against the lateral margin.", "mm"}, e.signed_error_mm);
  v({"abs_error_mm", "Absolute error of the layer's mid-line.", "mm"}, e.abs_error_mm);
}

/// One simulated incision and its evaluation.
struct SimulatedCut {
  IncisionResult incision;
  Evaluation centerline;                    ///< mid-line against the lateral margin, stretched tissue before the cut
  Evaluation inner_edge;                    ///< inner edge against margin less electrode radius, tool out
  std::vector<LayerErrors> layers;          ///< one for each of incision.kerf.layers
  Outcome outcome = Outcome::NotConverged;  ///< of incision and margin together
  std::size_t tets = 0;                     ///< of the mesh before the cut
  /// How far beside the real electrode heat damages tissue where the path is slowest and shallowest, mm.
  double thermal_half_width_mm = 0.0;
  /// Open cut beside a known tumour edge: least distance of its mid-lines, at any depth, from the edge, seen along the
  /// approach, mm; below 0: within the tumour.
  std::optional<double> line_to_edge_mm;
  /// Unheated tissue beside the tumour edge, mm: least distance of the mid-line from the edge minus the half width;
  /// below 0: heat reaches the edge. Absent without a mid-line, and for an open cut without a tumour edge.
  std::optional<double> thermal_margin_mm;
  Verdict verdict;  ///< objections to the path that was cut: verdict_of_cut and verdict_before_cut
};
void describe(Visitor& v, SimulatedCut& cut);

/// How the path was corrected.
struct Correction {
  CompensationMethod method = CompensationMethod::Default;
  /// The corrected path. Errors per waypoint are those of the cut as planned (method profile: the expected ones), moves
  /// are from the path that this cut followed.
  Compensation moves;
  std::optional<double> floor_mm;                  ///< see mesh_floor_mm; the default method only
  std::optional<ConvergedCompensation> iteration;  ///< passes of the default method only
};
inline void describe(Visitor& v, Correction& c) {
  v("method", c.method, "How the path was corrected.");
  v("floor_mm", c.floor_mm, "Mesh-resolution limit: mean |error| that the mesh alone causes.");
  describe(v, c.moves);
  v.bulk("iteration", c.iteration, "The correction, pass by pass.");
  if (c.iteration && v.is_summary()) describe(v, *c.iteration);
}

}  // namespace incise
