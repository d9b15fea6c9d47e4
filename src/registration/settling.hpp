#pragma once

#include "registration/surface_match.hpp"

#include <incise/core/workers.hpp>
#include <incise/registration/drift.hpp>

namespace incise {

struct SettlingSettings {
  ScaleRange scale;
  double largest = 0.03;  ///< how far tissue may have settled, in the clouds' unit, > 0: two standard deviations
  double range = 0.65;    ///< distance over which settling varies: width of its Gaussians, in the clouds' unit
  int max_iterations = 30;
  double tolerance = 1e-3;  ///< converged when a motion moves the source by less than this length
};

/// A pose and the settling found with it.
struct SettledPose {
  Similarity transform;
  double settled_rms = 0.0;      ///< of the settling, over the source's points
  double settled_largest = 0.0;
  double apart_rms = 0.0;  ///< of the part of the settling, along the normals, that no change of the pose explains
  double apart_largest = 0.0;
  double noise = 0.0;            ///< robust standard deviation of the residual
  Mat7 covariance = Mat7::Zero();  ///< as in PoseObservability, about `center`
  Vec3 center = Vec3::Zero();
  double length = 0.0;  ///< rms distance of the points from the centre
  bool has_converged = false;
  bool is_degenerate = false;  ///< too few pairs
  int iterations = 0;
  PointCloud settled;  ///< the source's points that were used (at most 3000), moved and settled
};

/// Finds the similarity between a surface and a measured one that has settled since. Pose and a smooth displacement
/// along the source's mean normal are found together; the displacement is a Gaussian process with covariance
/// (largest/2)² exp(-r² / (2 range²)). Plain least squares would mistake a dip in the back of a tongue for a shift of
/// the whole. Distances are heights, along the source's normals, of quadratics fitted to the target's points around
/// each moved source point: the normals of a noisy cloud would make every motion look better determined than it is.
/// Displacement across the mean normal is not found: shapes cannot distinguish it from a shift.
[[nodiscard]] SettledPose settled_pose(const SampledSurface& source, const SampledSurface& target,
                                       const Similarity& start, const SettlingSettings& settings, Workers& workers);

}  // namespace incise
