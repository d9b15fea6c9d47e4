#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

/// A bench that is quick and coarse: numbers of its own, the same order.
BenchBody coarse_body(double arm_error) {
  Specimen specimen = draw_specimen(2);
  specimen.robot_offset_x_mm = specimen.robot_offset_y_mm = arm_error;
  specimen.robot_offset_z_mm = specimen.robot_turn_deg = specimen.robot_wander_mm = 0.25 * arm_error;
  Workers workers(1);
  Monitor silent;
  return make_body(specimen, {.fine_mm = 3.0, .coarse_mm = 8.0, .way_mm = 1.0}, workers, silent);
}

double mean_abs_mm(const BenchBody& body, const BenchCut& cut) {
  double sum = 0.0;
  const std::vector<double> errors = true_errors_mm(body, cut, kInnerEdgeTargetMm);
  for (const double e : errors) sum += std::abs(e) / static_cast<double>(errors.size());
  return sum;
}

TEST(CutKnowingPhysics, CorrectsByTheBenchsOwnLawAndNotByTheArmsErrors) {
  Workers workers(1);
  Monitor silent;
  const BenchBody good = coarse_body(0.0), shifted = coarse_body(2.0);
  const KnownPhysicsCut near = cut_knowing_physics(good, {}, 3, workers, silent);
  const KnownPhysicsCut far = cut_knowing_physics(shifted, {}, 3, workers, silent);
  ASSERT_TRUE(near.cut.inner_edge && far.cut.inner_edge);
  ASSERT_GE(near.correction.passes.size(), 2U);
  // What the correction sees is the same whatever the arm hides …
  ASSERT_EQ(near.correction.passes.size(), far.correction.passes.size());
  for (std::size_t k = 0; k < near.correction.passes.size(); ++k)
    EXPECT_EQ(near.correction.passes[k].mean_abs_error_mm, far.correction.passes[k].mean_abs_error_mm) << k;
  // … it wins, and an arm that is off by 2 mm each way spoils the cut that follows.
  EXPECT_LT(*near.correction.result().mean_abs_error_mm, 0.6 * *near.correction.passes.front().mean_abs_error_mm);
  EXPECT_GT(mean_abs_mm(shifted, far.cut), mean_abs_mm(good, near.cut) + 0.3);
}

TEST(CutKnowingPhysics, RefusesABodyWithoutEquilibrium) {
  BenchBody body = coarse_body(0.0);
  body.outcome = Outcome::NotConverged;
  Workers workers(1);
  Monitor silent;
  EXPECT_THROW(static_cast<void>(cut_knowing_physics(body, {}, 3, workers, silent)), InvalidArgument);
}

}  // namespace
}  // namespace incise
