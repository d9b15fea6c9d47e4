#pragma once

#include <incise/imaging/made_skin.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/products.hpp>

#include <optional>
#include <span>

namespace incise {

/// Refuses to cut tissue whose tets each resist a change of volume (material.volume per_tet) at a Poisson's ratio above
/// 0.495. Such tets lock: they are dragged too little, and the errors come out too small without any other sign
/// (docs/records/cutting.md).
/// @throws CaseError (field specimen.material.volume)
void require_no_locking(const TissueModel& model);

/// Returns the mean edge length at rest, mm, of the tets that the tool will meet along a path; nullopt if no tissue is
/// near it.
/// @param stretched  positions before the cut, mm, in the path's frame.
[[nodiscard]] std::optional<double> edge_along_mm(const TissueModel& model, std::span<const Vec3> stretched,
                                                  const ToolPath& path, const Vec3& approach);

/// Where the tool's tip comes nearest to a platform that supports the tissue, or goes farthest below it.
struct PlatformClearance {
  double height_mm = 0.0;   ///< of the tip above the plane, along its normal; negative: below
  std::size_t waypoint = 0;
};
/// Finds the least clearance over all waypoints and all planes of the model's support constraints; nullopt without a
/// plane. Ignores a holder's surface, which is not a plane.
[[nodiscard]] std::optional<PlatformClearance> platform_clearance(const TissueModel& model, const ToolPath& path);

/// Returns the objections to a cut along a path that are known before the cut: tissue that begins to lock, a cut rule
/// other than the default, a mesh too coarse for the tool, a tip that goes through the platform, an entry or an edge on
/// a face that the region of interest made, or on skin that strokes of the brush made.
/// @param made_skin  of the tissue at rest; empty for a specimen given as a mesh.
[[nodiscard]] Verdict verdict_before_cut(const Case& settings, const TissueModel& model, const MadeSkin& made_skin,
                                         std::span<const Vec3> stretched, const ToolPath& path);

}  // namespace incise
