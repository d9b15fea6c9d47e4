#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <functional>
#include <optional>

namespace incise {

/// Mean |error|, mm, that the mesh alone leaves: of a cut along the path into the stretched tissue, held in place at
/// every vertex, with a tool that does not drag. For the mid-line that of its distances from the lateral margin; for
/// the inner edge that of its distances from their own mean, as the width of a kerf without drag is another. nullopt:
/// that cut left nothing to measure.
/// @throws Cancelled when the monitor asks to stop.
[[nodiscard]] std::optional<double> mesh_floor_mm(const Case& settings, const TissueModel& model,
                                                  const TissueState& stretched, const ToolPath& path, Workers& workers,
                                                  Monitor& monitor);

/// The errors of a cut that its path is corrected by: those of the line that the case observes, in the stretched tissue
/// before the cut. A ring without a closed mid-line near the skin is measured by its shallowest closed layer, seen
/// along the approach (reported to `monitor`). nullopt: there is none.
[[nodiscard]] std::optional<PathErrors> path_errors(const Case& settings, const SimulatedCut& cut,
                                                    const Contour& tumor_edge, Monitor& monitor);

/// What a list of one value for each sector, from the case's start direction on, says of each waypoint.
/// @throws InvalidArgument as values_at.
[[nodiscard]] std::vector<double> values_at_waypoints(const Case& settings, const std::vector<double>& sectors,
                                                      const ToolPath& path, const Contour& tumor_edge);

/// Where the case lets waypoints go.
[[nodiscard]] SafeRegion safe_region(const Case& settings);

/// One pass of the paper's rule. @pre the cut has a mid-line.
[[nodiscard]] Correction correct_as_paper(const Case& settings, const ToolPath& followed, const SimulatedCut& cut,
                                          const Contour& tumor_edge, const SurfaceQuery& surface);

/// Each waypoint moves by what `compensation.photographed_mm` says of its direction; no simulated cut takes
/// part. @pre the list is not empty. @throws as shift_path.
[[nodiscard]] Correction correct_by_profile(const Case& settings, const ToolPath& followed, const Contour& tumor_edge,
                                            const SurfaceQuery& surface);

/// Simulates the cut of a pass (0: along the path as followed first).
using CutOfPass = std::function<SimulatedCut(int pass, const ToolPath& path)>;

/// Corrects pass by pass, with at most kUsualPasses cuts after the first, or kMostPasses where something is held
/// against the nearest ring. @param floor_mm  see mesh_floor_mm; nothing: 0 is aimed at.
[[nodiscard]] Correction correct_converging(const Case& settings, const ToolPath& followed, const Contour& tumor_edge,
                                            const SurfaceQuery& surface, std::optional<double> floor_mm,
                                            const CutOfPass& cut, Monitor& monitor);

/// Why a correction is not accepted, as the end of a sentence; empty: it is. The paper's rule (II-C.5): a corrected cut
/// is accepted when its mean |error| is below the electrode's radius. Ours adds that it has to succeed, to be nearer
/// than the first cut, where that could be measured, and not to buy that with depth or closure: it leaves no more
/// planned layers open than the first cut, and its least depth is that of the rule `depth`, or that of the first cut.
/// A path by photographs is held to success, closure and depth alone: it corrects what the simulation does not show.
[[nodiscard]] std::string objection_to(const Case& settings, const Correction& correction, const SimulatedCut& first,
                                       const SimulatedCut& corrected);

}  // namespace incise
