#pragma once

#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/products.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// What speaks against a cut along a path before it is made, a sentence each: tissue that begins to lock, a mesh too
/// coarse for the tool.
[[nodiscard]] std::vector<std::string> doubts_before_cut(const Case& settings, const TissueModel& model,
                                                         std::span<const Vec3> stretched, const ToolPath& path);

/// What a cut's outcome does not say, a sentence each: layers below the mid-line's that stayed open, heat that reaches
/// the tumour edge.
[[nodiscard]] std::vector<std::string> doubts_about(const SimulatedCut& cut);

}  // namespace incise
