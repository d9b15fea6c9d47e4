#pragma once

#include <incise/evaluation/t_tests.hpp>

#include <optional>
#include <span>

namespace incise {

/// A difference, after minus before, in standard deviations.
struct EffectSize {
  double cohens_d = 0.0;  ///< difference / sd; for few values too large on average
  double hedges_g = 0.0;  ///< d without that bias
  Interval confidence;    ///< of g, at the given level, from the noncentral t distribution
};

inline void describe(Visitor& v, EffectSize& e) {
  v("hedges_g", e.hedges_g, "Hedges' g: difference over standard deviation, corrected for bias.");
  v("cohens_d", e.cohens_d, "Cohen's d: the same without the correction for bias.");
  std::optional<Interval> confidence = e.confidence;
  describe_interval(v, {"confidence", "Confidence interval of Hedges' g."}, confidence);
  if (v.sets()) e.confidence = confidence.value_or(Interval{});
}

/// Computes the effect size of two samples: g is the difference divided by their common standard deviation, times
/// Γ(f/2) / (√(f/2) Γ((f−1)/2)) with f = n_before + n_after − 2. Absent for f < 2, without spread, and for |t| > 300,
/// where the interval cannot be computed. Source: [Hedges1981].
/// @param level  of the confidence interval, (0, 1).
/// @pre as student_t_test.
[[nodiscard]] std::optional<EffectSize> hedges_g(const SampleMoments& before, const SampleMoments& after,
                                                 double level = 0.95);

/// Computes the effect size of pairs: as hedges_g, with the mean difference, the standard deviation of the differences
/// and f = pairs − 1. Absent for fewer than 3 pairs, without spread, and for |t| > 300. @pre as paired_t_test.
[[nodiscard]] std::optional<EffectSize> hedges_g_paired(std::span<const double> before, std::span<const double> after,
                                                        double level = 0.95);

enum class TestDesign {
  Unpaired,  ///< two groups of equal size
  Paired,    ///< each specimen before and after
};

/// Returns the probability that a two-tailed t-test at level `alpha` detects a true effect of `effect` standard
/// deviations.
/// @param n  specimens in each group, or pairs.
/// @pre n >= 2, alpha in (0, 1), effect finite (InvalidArgument). Source: [Cohen1988], noncentral t distribution.
[[nodiscard]] double t_test_power(double effect, std::size_t n, TestDesign design, double alpha = 0.05);

/// Returns the fewest specimens in each group (or pairs) for which t_test_power reaches `power`. Absent for an effect
/// of 0, and if more than 1 000 000 would be needed. @pre power in (alpha, 1) (InvalidArgument).
[[nodiscard]] std::optional<std::size_t> fewest_specimens(double effect, TestDesign design, double power = 0.8,
                                                          double alpha = 0.05);

}  // namespace incise
