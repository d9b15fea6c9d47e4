#pragma once

#include "registration/surface_match.hpp"

#include <incise/registration/drift.hpp>

namespace incise {

struct IcpSettings {
  ScaleRange scale;
  double first_width = 0.05;  ///< of the robust weight at the start, in the clouds' unit
  double tolerance = 1e-4;  ///< converged when the mean of the last four motions moves the source by less than this
                            ///< length (rms), and none of them by ten times as much
  int max_iterations = 60;
  std::size_t max_points = 0;  ///< of each cloud that are used, evenly spread; 0: all
};

struct Icp {
  Similarity transform;
  bool has_converged = false;
  bool is_degenerate = false;  ///< too few pairs
  int iterations = 0;
  double width = 0.0;  ///< of the robust weight at the end: about 2.5 times the noise
};

/// Point-to-plane ICP (iterated closest points) with scale and pairs from both clouds: Gauss-Newton on the distances
/// along the mean of both normals, each weighted by exp(-d²/2τ²), where τ shrinks to 2.5 robust standard deviations of
/// the distances. Directions that the surfaces do not determine are damped. Sources: [ChenMedioni1992],
/// [Rusinkiewicz2019], [HollandWelsch1977].
[[nodiscard]] Icp icp(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
                      const IcpSettings& settings, Workers& workers);

/// Returns the gradient of a pair's distance with respect to a small motion of the moved source (rotation vector about
/// `center`, translation, logarithm of the scale).
[[nodiscard]] Vec7 pair_gradient(const SurfacePair& pair, const Vec3& center);

/// Returns t followed by the motion.
[[nodiscard]] Similarity nudged(const Similarity& t, const Vec7& motion, const Vec3& center);

}  // namespace incise
