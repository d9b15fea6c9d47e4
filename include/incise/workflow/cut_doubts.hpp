#pragma once

#include <incise/imaging/made_skin.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/products.hpp>

#include <optional>
#include <span>

namespace incise {

/// Refuses to cut tissue of which a tet resists change of volume by itself at a Poisson's ratio above 0.495: such tets
/// lock, are dragged less than they should be, and the errors come out too small without any other sign
/// (docs/records/cutting.md).
/// @throws CaseError (field specimen.material.volume)
void require_no_locking(const TissueModel& model);

/// Mean edge length at rest, mm, of the tets that the tool will meet along a path; nothing where the tissue is nowhere
/// near it.
/// @param stretched  positions before the cut, mm, in which the path is given.
[[nodiscard]] std::optional<double> edge_along_mm(const TissueModel& model, std::span<const Vec3> stretched,
                                                  const ToolPath& path, const Vec3& approach);

/// Where the tool's tip comes nearest to a platform that supports the tissue, or farthest below it.
struct PlatformClearance {
  double height_mm = 0.0;   ///< of the tip above the plane, along its normal; negative: below
  std::size_t waypoint = 0;
};
/// Over all waypoints and all planes of the case's support constraints (of the default ones, where none are given); nothing without a plane.
/// A holder's surface is no plane and is not looked at.
[[nodiscard]] std::optional<PlatformClearance> platform_clearance(const TissueModel& model, const ToolPath& path);

/// What argues against a cut along a path before it is made: tissue that begins to lock, a mesh too coarse for the
/// tool, a tip that goes through the platform, an entry or an edge on a face that the region of interest made, or on
/// skin that strokes of the brush made.
/// @param made_skin  of the tissue at rest; none for a specimen that was given as a mesh.
[[nodiscard]] Verdict verdict_before_cut(const Case& settings, const TissueModel& model, const MadeSkin& made_skin,
                                         std::span<const Vec3> stretched, const ToolPath& path);

}  // namespace incise
