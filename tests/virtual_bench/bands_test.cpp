#include "support/planner_fit.hpp"
#include "virtual_bench/small_bench.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kTargetMm = 4.5;  // Paper III-A.1: of an inner edge

/// Mean and standard deviation along the contour of the absolute error of a cut at the bench's own resolution.
struct Cut {
  Outcome outcome = Outcome::NotConverged;
  double mean_mm = 0.0, sd_mm = 0.0;
};
Cut cut_as_planned(std::uint64_t seed) {
  Workers workers(1);
  Monitor monitor;
  const BenchBody body = make_body(draw_specimen(seed), {}, workers, monitor);
  const BenchCut cut = cut_specimen(body, test::ring_course(body, 7.0), 35.0, workers, monitor);
  Cut result{cut.outcome};
  if (!cut.inner_edge) return result;
  const std::vector<double> errors = true_errors_mm(body, cut, kTargetMm);
  const auto n = static_cast<double>(errors.size());
  double squares = 0.0;
  for (const double e : errors) {
    result.mean_mm += std::abs(e) / n;
    squares += e * e;
  }
  result.sd_mm = std::sqrt((squares - n * result.mean_mm * result.mean_mm) / (n - 1.0));
  return result;
}

// The paper's two cuts along the intended path: 1.57 +- 0.66 and 1.91 +- 0.90 mm (Table II). Of three specimens this
// asserts that each ring closes with a mean absolute error of 1.0 to 2.5 mm, that the mean of the three means lies in
// 1.4 to 2.1 mm, and that the mean of their three standard deviations along the contour lies in 0.5 to 1.0 mm. What is
// wanted of the bench is more: a mean standard deviation of 0.6 to 1.0 mm over some 200 specimens. Single specimens lie
// anywhere from 0.4 to 1.0 mm, so that three cannot tell 0.6 from a little less: `incise_bench_study 1 200 photo=1`
// judges both bands on 200 (23 min on two cores; 1.631 and 0.603 mm, docs/records/virtual_bench.md).
TEST(BenchBands, CutsAsPlannedErrAsThePapersDo) {
  double means = 0.0;
  double sds = 0.0;
  constexpr int kSeeds = 3;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Cut cut = cut_as_planned(seed);
    ASSERT_EQ(cut.outcome, Outcome::Success) << "seed " << seed;
    EXPECT_GT(cut.mean_mm, 1.0) << "seed " << seed;
    EXPECT_LT(cut.mean_mm, 2.5) << "seed " << seed;
    means += cut.mean_mm / kSeeds;
    sds += cut.sd_mm / kSeeds;
  }
  EXPECT_GT(means, 1.4);
  EXPECT_LT(means, 2.1);
  EXPECT_GT(sds, 0.5) << "below what three specimens of a bench with 0.6 mm would show";
  EXPECT_LT(sds, 1.0);
}

// No inverse crime: the planner's own simulation, fitted as well as it can be, has to leave 0.25 to 0.6 mm of the
// signed error of one cut of the bench. Of two specimens; `incise_bench_fit` measures more.
TEST(BenchBands, WhatThePlannersBestFitLeavesIsNeitherNothingNorAll) {
  for (const std::uint64_t seed : {2U, 3U}) {
    const auto fit = testing::fit_planner_to_bench(seed, 15000);
    ASSERT_TRUE(fit.has_value()) << "seed " << seed;
    EXPECT_GT(fit->residual_rms_mm, testing::kLeastResidualMm) << "seed " << seed;
    EXPECT_LT(fit->residual_rms_mm, testing::kMostResidualMm) << "seed " << seed;
    EXPECT_LT(fit->residual_rms_mm, fit->seen_mean_abs_mm) << "a fit that is worse than none";
  }
}

}  // namespace
}  // namespace incise
