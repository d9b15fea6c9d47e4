#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/expected_errors.hpp>
#include <incise/workflow/products.hpp>

namespace incise {

/// What a simulated cut itself holds against its path: its outcome, planned layers that stayed open, the kerf's
/// distance from the tumour's surface and from its edge, depth, heat, and how well it was solved. Limits are those of
/// verdict_rules(); the close margin and the planned depth are the case's.
/// @param cut  measured and evaluated; its own `verdict` is not read.
/// @param expected  of real cuts beyond simulated ones: the margin beside the edge is judged with it. The distance to
///                  the tumour's surface is the simulated kerf's.
/// @note Without the tumour's surface the edge counts in every layer that was cut, as if the tumour went straight down
/// from it. Source: docs/models/verdict.md; the close margin: [Paper, III-A.1].
[[nodiscard]] Verdict verdict_of_cut(const Case& settings, const SimulatedCut& cut,
                                     const ExpectedErrors& expected = {});

/// Least tissue that a simulated cut leaves between its kerf and the tumour, mm; negative: the kerf enters it. The
/// lesser of what `simulated_margin` and `tumor_distance` hold against the close margin. Absent: nothing was measured.
[[nodiscard]] std::optional<double> nearest_to_tumor_mm(const Case& settings, const SimulatedCut& cut);

/// Share of the planned depth that the kerf reaches at each place of its depth profile (N, >= 0). Planned is the tip's depth on the path, or
/// the case's plan.depth_mm where that is more: a path that is too shallow does not excuse a shallow kerf.
[[nodiscard]] std::vector<double> depth_shares(const Case& settings, const DepthReached& depth);

/// Depths of the layers within the plan that a cut left open, mm, in the order of the layers.
[[nodiscard]] std::vector<double> open_layers_mm(const IncisionResult& incision);

/// How a tumour's edge and its surface fit together, seen along the approach.
struct EdgeFit {
  double apart_mm = 0.0;   ///< farthest that a point of the one lies outside the other, >= 0
  Vec3 at_mm = Vec3::Zero();  ///< that point
};

/// Compares a tumour's edge with the outline of its surface (the convex hull of what is seen of it), whatever their heights.
/// @param edge  closed, at least 3 points, mm.  @param surface  with vertices, mm, the edge's coordinates. O(edge · hull).
[[nodiscard]] EdgeFit edge_fit(const Contour& edge, const TriMesh& surface, const Vec3& approach);

/// Refuses an edge that does not fit the surface (contour_surface), or fits it only with x and y turned (contour_flipped): such an edge was
/// drawn in RAS and saved without a stamp.
[[nodiscard]] Verdict verdict_of_contour(const Contour& edge, const TriMesh& surface, const Vec3& approach);

/// What `not_corrected` says of a path as planned. @param note  see objection_to.
[[nodiscard]] std::string uncorrected_path(const std::string& note);
/// The same of a path that was corrected, where the correction was rejected.
[[nodiscard]] std::string rejected_correction(const std::string& note);

/// The verdict of a run: that of the cut that verifies the path which a program would follow, and what is known beside
/// it.
/// @param about_inputs  what was found before anything was cut.
/// @param cut           along the path that a program would follow; null: none was made.
/// @param objection     to the correction that was asked for, see objection_to; nothing: none was asked for, or it is
///                      accepted.
[[nodiscard]] Verdict verdict_of_run(const Case& settings, const Verdict& about_inputs, const SimulatedCut* cut,
                                     const std::optional<std::string>& objection);

}  // namespace incise
