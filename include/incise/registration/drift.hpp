#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/workers.hpp>
#include <incise/registration/similarity.hpp>

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace incise {

/// Allowed range of a registration's scale; low = high fixes it.
struct ScaleRange {
  double low = 1.0;
  double high = 1.0;
  [[nodiscard]] static ScaleRange fixed(double scale = 1.0) { return {scale, scale}; }
  [[nodiscard]] static ScaleRange free();  ///< any scale above 0
  [[nodiscard]] bool is_fixed() const { return low == high; }
};
inline void describe(Visitor& v, ScaleRange& r) {
  v("low", r.low, "Least scale.", kNotNegative);
  std::optional<double> high = if_finite(r.high);
  v("high", high, "Greatest scale, not below the least; absent: no limit.", kPositive);
  if (v.sets()) r.high = high.value_or(std::numeric_limits<double>::infinity());
}

/// Settings of coherent point drift. Lengths are shares of the target's root mean square radius, so none has a unit.
struct DriftSettings {
  ScaleRange scale = ScaleRange::free();
  double outlier_weight = 0.1;
  int max_iterations = 300;
  double tolerance = 1e-4;
  int dimensions = 3;
  bool coarse_to_fine = true;
  std::optional<double> first_sigma;
};
inline void describe(Visitor& v, DriftSettings& s) {
  v("scale", s.scale, "Range of the scale; low = high fixes it.");
  v("outlier_weight", s.outlier_weight, "Share of the target that has no counterpart in the source (w).",
    {0.0, 1.0, true, true});
  v("max_iterations", s.max_iterations,
    "Greatest number of steps of expectation and maximisation, on all levels together.", {1.0});
  v("tolerance", s.tolerance,
    "Converged when all further steps together would move the source by less than this (estimated), as a share of the "
    "radius.",
    kPositive);
  v("dimensions", s.dimensions, "3; or 2 for drawings with all z equal, with rotation about z only.", {2.0, 3.0});
  v("coarse_to_fine", s.coarse_to_fine, "Whether wide Gaussians use clusters in place of points.");
  v("first_sigma", s.first_sigma,
    "First width of the Gaussians, as a share of the radius; absent: from the clouds' mean squared distance.",
    kPositive);
}

/// Returns every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const DriftSettings& settings);

enum class DriftOutcome {
  Converged,
  IterationLimit,
  Degenerate,  ///< no rotation can be determined: the points of one cloud, or those that still match, lie on a line or
               ///< in one point
  Cancelled,
};
inline constexpr std::array<std::string_view, 4> kDriftOutcomeNames{"converged", "iteration_limit", "degenerate",
                                                                    "cancelled"};
[[nodiscard]] constexpr Names names_of(DriftOutcome) {
  return kDriftOutcomeNames;
}

struct CoherentPointDrift {
  Similarity T_target_source;
  DriftOutcome outcome = DriftOutcome::IterationLimit;
  double sigma_mm = 0.0;       ///< width of the Gaussians at the end
  double matched_share = 0.0;  ///< of the target's points, by probability, [0, 1]
  int iterations = 0;
  double last_step_mm = 0.0;  ///< root mean square movement of the source in the last step
};

/// Aligns the source with the target by rigid coherent point drift with scale, from one start. The target is modelled
/// as drawn from Gaussians about the moved source points and a uniform background; transform and width maximise the
/// likelihood (EM). The E-step truncates the Gaussians and, while they are wide, replaces points by clusters; the last
/// steps use all points, so the fixed point is that of all pairs up to the truncation. A scale range restricts the
/// M-step exactly, because its objective is a parabola in the scale. Neither unit nor origin matters. Memory O(N + M).
/// Without `first_sigma` only the start's rotation counts: centroids and sizes are matched first, as published.
/// @param source, target  M x 3 and N x 3, any unit, the result's too.  @param start  initial transform, scale > 0.
/// @throws InvalidArgument for an empty cloud, a point that is not finite, or a bad start or setting.
/// Source: [Myronenko2010], Fig. 2.
[[nodiscard]] CoherentPointDrift rigid_drift(std::span<const Vec3> source, std::span<const Vec3> target,
                                             const Similarity& start, const DriftSettings& settings, Workers& workers,
                                             Monitor& monitor);

}  // namespace incise
