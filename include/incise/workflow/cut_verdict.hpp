#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/expected_errors.hpp>
#include <incise/workflow/products.hpp>

namespace incise {

/// Returns the objections to a path by its simulated cut: outcome, planned layers that stayed open, the kerf's distance
/// from the tumour's surface and from its edge, depth, heat, and how well the cut was solved. Limits are those of
/// verdict_rules(); the close margin and the planned depth are the case's.
/// @param cut  measured and evaluated; its own `verdict` is not read.
/// @param expected  errors of real cuts beyond simulated ones. They count for the margin beside the edge; the distance
/// to the tumour's surface is that of the simulated kerf.
/// @note Without the tumour's surface the edge counts in every layer that was cut, as if the tumour went straight down
/// from it. Source: docs/models/verdict.md; the close margin: [Paper, III-A.1].
[[nodiscard]] Verdict verdict_of_cut(const Case& settings, const SimulatedCut& cut,
                                     const ExpectedErrors& expected = {});

/// Returns the least tissue that a simulated cut leaves between its kerf and the tumour, mm; negative: the kerf enters
/// the tumour. It is the lesser of the distances that `simulated_margin` and `tumor_distance` compare with the close
/// margin. nullopt: nothing was measured.
[[nodiscard]] std::optional<double> nearest_to_tumor_mm(const Case& settings, const SimulatedCut& cut);

/// How much of the planned depth a kerf reaches at one place of its depth profile.
struct DepthShare {
  std::size_t at = 0;       ///< place in the profile
  double planned_mm = 0.0;  ///< planned depth there, > 0
  double share = 0.0;       ///< reached depth over planned depth, >= 0
};

/// Returns the share of the planned depth that the kerf reaches at each place of its depth profile where a depth is
/// planned, in the profile's order. The planned depth is the tip's depth on the path. With tool_axis approach it is at
/// least the case's plan.depth_mm: a path that is too shallow does not excuse a shallow kerf.
[[nodiscard]] std::vector<DepthShare> depth_shares(const Case& settings, const DepthReached& depth);

/// Returns the depths, mm, of the layers within the plan that a cut left open, in the order of the layers.
[[nodiscard]] std::vector<double> open_layers_mm(const IncisionResult& incision);

/// How a tumour's edge and its surface fit together, seen along the approach.
struct EdgeFit {
  double apart_mm = 0.0;      ///< greatest distance of a point of one outside the other, in the picture, >= 0
  Vec3 at_mm = Vec3::Zero();  ///< that point, at height 0 of the view
};

/// Compares a tumour's edge with the outline of its surface in the picture (the convex hull of its vertices), whatever
/// their heights. O(edge · hull).
/// @param edge  closed, at least 3 points, mm.  @param surface  with vertices, mm, same frame as the edge.
/// @throws InvalidArgument for too few points or vertices.
[[nodiscard]] EdgeFit edge_fit(const Contour& edge, const TriMesh& surface, const Vec3& approach);

/// Refuses an edge that does not fit the surface (contour_surface), or fits it only with x and y turned
/// (contour_flipped): such an edge was drawn in RAS and saved without stating it.
[[nodiscard]] Verdict verdict_of_contour(const Contour& edge, const TriMesh& surface, const Vec3& approach);

/// Returns the message of `not_corrected` for a path as planned. @param note  see objection_to.
[[nodiscard]] std::string uncorrected_path(const std::string& note);
/// Returns the message of `not_corrected` for a corrected path whose correction was rejected.
[[nodiscard]] std::string rejected_correction(const std::string& note);

/// Returns the verdict of a run: that of its verifying cut, with what is known beside it.
/// @param about_inputs  objections found before anything was cut.
/// @param cut           along the path that a program would follow; null: none was made.
/// @param objection     to the correction that was requested, see objection_to; nullopt: none was requested, or it is
/// accepted.
[[nodiscard]] Verdict verdict_of_run(const Case& settings, const Verdict& about_inputs, const SimulatedCut* cut,
                                     const std::optional<std::string>& objection);

}  // namespace incise
