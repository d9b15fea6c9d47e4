#pragma once

#include "registration/levels.hpp"

#include <incise/core/workers.hpp>
#include <incise/registration/drift.hpp>

namespace incise {

inline constexpr double kLeastSigma = 1e-6;  ///< in radii; below it the clouds coincide

/// Result of the E-step for a rigid M-step: sums over all pairs, each with its probability P.
struct MatchSums {
  double count = 0.0;           ///< N_P = Σ P
  Vec3 target = Vec3::Zero();   ///< Σ P x
  Vec3 source = Vec3::Zero();   ///< Σ P y
  Mat3 cross = Mat3::Zero();    ///< Σ P x yᵀ
  double target_squares = 0.0;  ///< Σ P |x|²
  double source_squares = 0.0;  ///< Σ P |y|²
};

/// Returns the uniform background, in units of the Gaussians' sum: (2πσ²)^{D/2} w/(1-w) M/N.
[[nodiscard]] double background(double sigma, double outlier_weight, int dimensions, double source_count,
                                double target_count);

/// E-step. The target is mapped back to the source's frame, where the width of the Gaussians is σ divided by the scale.
/// O(pairs within reach).
[[nodiscard]] MatchSums match(const WeightedPoints& source, const WeightedPoints& target, const Similarity& t,
                              double sigma, const DriftSettings& settings, Workers& workers);

struct MatchedTransform {
  Similarity transform;
  double variance = 0.0;       ///< new σ²
  double matched = 0.0;        ///< N_P
  bool is_degenerate = false;  ///< the matched points do not determine a rotation
};

/// M-step: returns the similarity, with its scale in the range, and the variance that maximise the expected likelihood.
/// [Myronenko2010], eq. (16).
[[nodiscard]] MatchedTransform best_transform(const MatchSums& sums, const DriftSettings& settings);

}  // namespace incise
