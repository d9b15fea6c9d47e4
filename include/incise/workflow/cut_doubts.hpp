#pragma once

#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/products.hpp>

#include <optional>
#include <span>

namespace incise {

/// Refuses to cut tissue of which a tet resists change of volume by itself at a Poisson's ratio above 0.495: such tets
/// lock, are dragged less than they should be, and the errors come out too small without any other sign
/// (docs/models/cutting.md).
/// @throws CaseError (field specimen.material.volume)
void require_no_locking(const TissueModel& model);

/// Mean edge length at rest, mm, of the tets that the tool will meet along a path; nothing where the tissue is nowhere
/// near it.
/// @param stretched  positions before the cut, mm, in which the path is given.
[[nodiscard]] std::optional<double> edge_along_mm(const TissueModel& model, std::span<const Vec3> stretched,
                                                  const ToolPath& path, const Vec3& approach);

/// What argues against a cut along a path before it is made: tissue that begins to lock, a mesh too coarse for the tool.
[[nodiscard]] Verdict verdict_before_cut(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                                         const ToolPath& path);

}  // namespace incise
