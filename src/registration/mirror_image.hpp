#pragma once

#include "registration/icp.hpp"
#include "registration/pose_search.hpp"

namespace incise {

/// Points of a cloud that a pose is scored by, the proper one and the mirrored one alike.
inline constexpr std::size_t kScorePoints = 4000;

/// The best pose found for the source's mirror image: what the answer would be had one of the clouds been reflected.
/// Starts: the proper pose with the source reflected in each of its three principal planes, which is where a shape that
/// nearly is its own mirror image comes to lie; and, with `search`, a search over all rotations as for the source
/// itself, of which few poses are followed. The pose itself is of no use to anyone and is not returned.
/// @param proper  the pose that was found for the source as it is.  @param finish  of the last ICP, which sees all
/// points.
[[nodiscard]] Misfit mirror_image_misfit(const SampledSurface& source, const SampledSurface& target,
                                         const Similarity& proper, const std::optional<PoseSearchSettings>& search,
                                         const IcpSettings& finish, double score_width, Workers& workers,
                                         Monitor& monitor);

}  // namespace incise
