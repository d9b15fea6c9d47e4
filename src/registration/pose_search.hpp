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
  double score_width = 0.02;  ///< of overlap_score, as a length
  std::size_t keep = 8;
  std::size_t followed = 160;  ///< poses of the coarse stage that are brought closer with few points, the best ones
  std::size_t refined = 12;    ///< of those, the best ones, that are refined
};

struct Pose {
  Similarity transform;
  double score = 0.0;
};

struct PoseSearch {
  std::vector<Pose> poses;  ///< best first, no two alike
  int starts = 0;
};

/// Rotations spread evenly over all of them: the super-Fibonacci spiral of unit quaternions. Source: [Alexa2022].
[[nodiscard]] std::vector<Mat3> even_rotations(int count);

/// Whether two poses of this source mean different things: they take its points more than `limit` apart (rms).
[[nodiscard]] bool differ(const Similarity& a, const Similarity& b, std::span<const Vec3> source, double limit);

/// Rough poses, from drifts on coarse clusters with a width that shrinks on a fixed schedule, from every start, then
/// refined by ICP on a part of the points. Both clouds are centred, in units of the target's radius.
[[nodiscard]] PoseSearch search_poses(const SampledSurface& source, const SampledSurface& target,
                                      const PoseSearchSettings& settings, Workers& workers, Monitor& monitor);

}  // namespace incise
