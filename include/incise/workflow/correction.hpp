#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <functional>
#include <optional>

namespace incise {

/// Computes the mesh-resolution limit, mm: the mean |error| of a cut along the path into the stretched tissue, with
/// every vertex held in place and a tool that does not drag. For the mid-line, errors are against the lateral margin;
/// for the inner edge, against the mean distance, because a kerf without drag has another width. nullopt: that cut has
/// nothing to measure.
/// @throws Cancelled when the monitor asks to stop.
[[nodiscard]] std::optional<double> mesh_floor_mm(const Case& settings, const TissueModel& model,
                                                  const TissueState& stretched, const ToolPath& path, Workers& workers,
                                                  Monitor& monitor);

/// Returns the errors by which the path of a cut is corrected: those of the line that the case observes, in the
/// stretched tissue before the cut. A ring without a closed line near the skin is measured by its shallowest closed
/// layer, seen along the approach (reported to `monitor`). nullopt: no closed layer.
[[nodiscard]] std::optional<PathErrors> path_errors(const Case& settings, const SimulatedCut& cut,
                                                    const Contour& tumor_edge, Monitor& monitor);

/// Interpolates a list of values by sector, from the case's start direction on, at each waypoint of a path.
/// @throws InvalidArgument as values_at.
[[nodiscard]] std::vector<double> values_at_waypoints(const Case& settings, const std::vector<double>& sectors,
                                                      const ToolPath& path, const Contour& tumor_edge);

/// Returns the region to which the case restricts waypoints.
[[nodiscard]] SafeRegion safe_region(const Case& settings);

/// Corrects a path by one pass of the paper's rule. @pre the cut has a mid-line. @throws as compensate_paper.
[[nodiscard]] Correction correct_as_paper(const Case& settings, const ToolPath& followed, const SimulatedCut& cut,
                                          const Contour& tumor_edge, const SurfaceQuery& surface);

/// Moves each waypoint by minus the value of `compensation.photographed_mm` in its direction, without any simulated
/// cut. @pre the list is not empty. @throws as shift_path.
[[nodiscard]] Correction correct_by_profile(const Case& settings, const ToolPath& followed, const Contour& tumor_edge,
                                            const SurfaceQuery& surface);

/// Simulates the cut of a pass; pass 0 is the cut along the first path.
using CutOfPass = std::function<SimulatedCut(int pass, const ToolPath& path)>;

/// Corrects a path pass by pass, with at most kUsualPasses cuts after the first, or kMostPasses if there is an
/// objection to the nearest ring. @param floor_mm  see mesh_floor_mm; nullopt: 0.
[[nodiscard]] Correction correct_converging(const Case& settings, const ToolPath& followed, const Contour& tumor_edge,
                                            const SurfaceQuery& surface, std::optional<double> floor_mm,
                                            const CutOfPass& cut, Monitor& monitor);

/// Returns why a correction is not accepted, as the end of a sentence; empty if it is accepted. By the paper's rule
/// (II-C.5), a corrected cut is accepted if its mean |error| is below the electrode's radius. We also require that it
/// succeeds, that its error is below the first cut's if that was measured, that it leaves no more planned layers open
/// than the first cut, and that its least depth reaches the limit of the rule `depth` or the least depth of the first
/// cut. A correction by photographs needs only success, closure and depth, because it corrects errors that the
/// simulation does not show.
[[nodiscard]] std::string objection_to(const Case& settings, const Correction& correction, const SimulatedCut& first,
                                       const SimulatedCut& corrected);

}  // namespace incise
