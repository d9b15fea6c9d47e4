#include <incise/core/error.hpp>
#include <incise/evaluation/evaluation.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

Contour line(const Vec3& from, const Vec3& to) {
  return {.points = {from, to}, .is_closed = false};
}
const Contour kIntended = line(Vec3(0, 0, 0), Vec3(30, 0, 0));

TEST(EvaluateLine, TakesLateralOffsetsToTheLeftAsPositive) {
  const Evaluation left = evaluate_line(line(Vec3(0, 0.4, 0), Vec3(30, 0.4, 0)), kIntended);
  EXPECT_NEAR(left.signed_error_mm->mean, 0.4, 1e-12);
  EXPECT_NEAR(left.abs_error_mm->max, 0.4, 1e-12);
  const Evaluation right = evaluate_line(line(Vec3(0, -0.4, 0), Vec3(30, -0.4, 0)), kIntended);
  EXPECT_NEAR(right.signed_error_mm->mean, -0.4, 1e-12);
  EXPECT_EQ(left.outcome, Outcome::Success);
  EXPECT_FALSE(left.closed_loop.has_value());
  EXPECT_FALSE(left.hu_score.has_value());
}

TEST(EvaluateLine, KeepsOvershootOutOfTheErrors) {
  const Evaluation result = evaluate_line(line(Vec3(-2, 0, 0), Vec3(33, 0, 0)), kIntended);
  EXPECT_NEAR(result.abs_error_mm->max, 0.0, 1e-12);
  EXPECT_NEAR(result.coverage, 1.0, 1e-12);
  EXPECT_EQ(result.n_points, 121U);  // 30 mm of 35 mm in steps of 0.25
}

TEST(EvaluateLine, CallsACutThatFallsShortIncomplete) {
  const Evaluation result = evaluate_line(line(Vec3(0.5, 0, 0), Vec3(24, 0, 0)), kIntended);
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
  EXPECT_NEAR(result.start_gap_mm.value(), 0.5, 1e-12);
  EXPECT_NEAR(result.end_gap_mm.value(), 6.0, 1e-12);
  EXPECT_NEAR(result.coverage, 23.5 / 30.0, 1e-12);
}

TEST(EvaluateLine, DoesNotMindTheDirectionOfTheCut) {
  const Evaluation a = evaluate_line(line(Vec3(0, 0.3, 0), Vec3(30, -0.1, 0)), kIntended);
  const Evaluation b = evaluate_line(line(Vec3(30, -0.1, 0), Vec3(0, 0.3, 0)), kIntended);
  EXPECT_NEAR(a.signed_error_mm->mean, b.signed_error_mm->mean, 1e-9);
}

TEST(EvaluateLine, FollowsACurve) {
  const Contour bent{.points = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, .is_closed = false};
  const Contour cut{.points = {{0, -1, 0}, {11, -1, 0}, {11, 10, 0}}, .is_closed = false};
  const Evaluation result = evaluate_line(cut, bent);
  EXPECT_NEAR(result.signed_error_mm->max, -1.0, 1e-9);             // right of the line all the way
  EXPECT_NEAR(result.signed_error_mm->min, -std::sqrt(2.0), 0.05);  // at the outer corner
}

TEST(EvaluateLine, HasNoErrorsWithoutACut) {
  const Evaluation result = evaluate_line(std::nullopt, kIntended);
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
  EXPECT_FALSE(result.abs_error_mm.has_value());
  EXPECT_THROW(static_cast<void>(evaluate_line(std::nullopt, {.points = {{0, 0, 0}, {0, 0, 0}}, .is_closed = false})),
               InvalidArgument);
}

}  // namespace
}  // namespace incise
