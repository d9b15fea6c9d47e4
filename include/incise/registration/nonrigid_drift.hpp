#pragma once

#include <incise/core/describe.hpp>
#include <incise/registration/drift.hpp>

namespace incise {

/// Settings of non-rigid coherent point drift. Lengths are shares of the source's root mean square radius.
struct NonrigidSettings {
  double smoothness = 0.8;
  double stiffness = 30.0;
  double outlier_weight = 0.1;
  int max_iterations = 300;
  double tolerance = 1e-4;
  int dimensions = 3;
  int max_centers = 400;
  std::optional<double> first_sigma;
};
inline void describe(Visitor& v, NonrigidSettings& s) {
  v("smoothness", s.smoothness,
    "Nonrigid: range of the bending (β), as a share of the source's root mean square radius.", {0.01, 10.0});
  v("stiffness", s.stiffness, "Nonrigid: cost of bending against misfit (λ).", {1e-6, 1e6});
  v("outlier_weight", s.outlier_weight, "Share of the target that has no counterpart in the source (w).",
    {0.0, 1.0, true, true});
  v("max_iterations", s.max_iterations, "Greatest number of steps of expectation and maximisation.", {1.0});
  v("tolerance", s.tolerance,
    "Converged when a step moves the points by less than this share of the radius (rms), twice in a row.", kPositive);
  v("dimensions", s.dimensions, "3; or 2 for drawings with all z equal.", {2.0, 3.0});
  v("max_centers", s.max_centers, "Rank of the deformation; a smoother deformation needs a lower rank.", {4.0, 2000.0});
  v("first_sigma", s.first_sigma,
    "First width of the Gaussians, as in DriftSettings; for clouds that are already aligned, for example 0.1.",
    kPositive);
}

struct NonrigidDrift {
  Points moved_mm;  ///< M x 3: final positions of the source's points
  DriftOutcome outcome = DriftOutcome::IterationLimit;
  double sigma_mm = 0.0;       ///< width of the Gaussians at the end
  double matched_share = 0.0;  ///< of the target's points, by probability, [0, 1]
  double largest_move_mm = 0.0;
  int iterations = 0;
  int rank = 0;  ///< number of Gaussians whose sum is the deformation
};

/// Aligns the source with the target by non-rigid coherent point drift: as rigid_drift, but each source point moves by
/// a smooth field v(y) = Σ_c g(y, c) W_c, a sum of Gaussians of width β about `rank` centres spread evenly over the
/// source, at a cost of λ/2 WᵀGW. The centres lie β/2 apart (farther if that would exceed max_centers); at β/2 the
/// field omits less than a hundredth of one with a centre on every point. Memory O(rank · M); no matrix over pairs of
/// points.
/// @param source, target  M x 3 and N x 3, any unit, the result's too.
/// @pre the clouds are aligned as well as a similarity can (rigid_drift first).
/// @throws InvalidArgument for an empty cloud, a point that is not finite, or a setting out of range.
/// Source: [Myronenko2010], Fig. 4; centres in place of eigenvectors of G.
[[nodiscard]] NonrigidDrift nonrigid_drift(std::span<const Vec3> source, std::span<const Vec3> target,
                                           const NonrigidSettings& settings, Workers& workers, Monitor& monitor);

}  // namespace incise
