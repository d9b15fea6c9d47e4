#pragma once

#include "registration/surface_match.hpp"

#include <incise/core/monitor.hpp>
#include <incise/registration/drift.hpp>

namespace incise {

struct IcpSettings {
  ScaleRange scale;
  double first_width = 0.05;  ///< of the robust weight at the start, as a length in the clouds' unit
  double tolerance = 1e-4;  ///< converged when the last four motions together move the source by less than this length
                            ///< (rms), and none by ten times it
  int max_iterations = 60;
  std::size_t max_points = 0;  ///< of the source that are used, evenly spread; 0: all
};

struct Icp {
  Similarity transform;
  bool has_converged = false;
  bool is_degenerate = false;  ///< too few pairs
  int iterations = 0;
  double width = 0.0;  ///< of the robust weight at the end: about 2.5 times the noise
  std::size_t pairs = 0;
};

/// Iterated closest points, point to plane, with scale, pairs sought from both clouds: Gauss-Newton on distances along
/// the mean of both normals, each weighted by exp(-d²/2τ²), where τ shrinks to 2.5 robust standard deviations of the
/// distances. Directions that the surfaces do not fix are damped. Sources: [ChenMedioni1992], [Rusinkiewicz2019],
/// [HollandWelsch1977].
[[nodiscard]] Icp icp(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
                      const IcpSettings& settings, Workers& workers);

/// What one pair says about a small motion (rotation about `center`, translation, logarithm of the scale) of the moved
/// source.
[[nodiscard]] Eigen::Matrix<double, 7, 1> pair_gradient(const SurfacePair& pair, const Vec3& center);

/// The motion applied after t.
[[nodiscard]] Similarity nudged(const Similarity& t, const Eigen::Matrix<double, 7, 1>& motion, const Vec3& center);

}  // namespace incise
