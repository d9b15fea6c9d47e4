#pragma once

#include "registration/icp.hpp"
#include "registration/pose_search.hpp"

namespace incise {

/// Number of points used to score a pose, proper or mirrored.
inline constexpr std::size_t kScorePoints = 4000;

/// Returns the misfit of the best pose found for the source's mirror image. It fits well if one of the clouds was
/// reflected. Starts: the proper pose with the source reflected in each of its three principal planes, where a nearly
/// symmetric shape ends up; and, with `search`, a smaller search over all rotations. The pose itself is not returned.
/// @param proper  the pose found for the source itself.  @param finish  settings of the last ICP, on all points.
/// @param score_width  see overlap_score.
[[nodiscard]] Misfit mirror_image_misfit(const SampledSurface& source, const SampledSurface& target,
                                         const Similarity& proper, const std::optional<PoseSearchSettings>& search,
                                         const IcpSettings& finish, double score_width, Workers& workers,
                                         Monitor& monitor);

}  // namespace incise
