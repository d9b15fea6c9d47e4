#pragma once

#include "registration/surface_match.hpp"

#include <incise/core/monitor.hpp>
#include <incise/registration/drift.hpp>

#include <vector>

namespace incise {

struct PoseSearchSettings {
  ScaleRange scale;
  double outlier_weight = 0.3;
  int rotations = 96;
  double score_width = 0.02;  ///< width of overlap_score, a length
  std::size_t keep = 8;        ///< poses to return at most
  std::size_t followed = 160;  ///< best poses of the coarse stage, which are improved with few points
  std::size_t refined = 12;    ///< best of those, which are refined
};

struct Pose {
  Similarity transform;
  double score = 0.0;
};

struct PoseSearch {
  std::vector<Pose> poses;  ///< best first, all distinct
  int starts = 0;
};

/// Returns `count` rotations spread evenly over all rotations: the super-Fibonacci spiral of unit quaternions. Source:
/// [Alexa2022].
[[nodiscard]] std::vector<Mat3> even_rotations(int count);

/// Whether two poses of this source are distinct: they map its points more than `limit` apart (rms).
[[nodiscard]] bool differ(const Similarity& a, const Similarity& b, std::span<const Vec3> source, double limit);

/// Searches rough poses: runs drifts on coarse clusters from every start, with a width that shrinks on a fixed
/// schedule, then refines the best by ICP on a part of the points. @pre both clouds are centred, in units of the
/// target's radius.
[[nodiscard]] PoseSearch search_poses(const SampledSurface& source, const SampledSurface& target,
                                      const PoseSearchSettings& settings, Workers& workers, Monitor& monitor);

}  // namespace incise
