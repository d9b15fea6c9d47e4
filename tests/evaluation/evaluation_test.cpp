#include "support/contour_shapes.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/evaluation/level_loop.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace incise {
namespace {

/// A polygon of 1440 corners in place of a circle of 10 to 20 mm radius.
constexpr double kPolygonMm = 1e-4;

Contour ring(double radius_mm, const Vec3& center = Vec3::Zero()) {
  return testing::circle(radius_mm, 1440, center);
}

TEST(Evaluate, APerfectMidLineHasNoErrorAgainstFiveAndHalfAMillimetreAgainstThePapersTarget) {
  const Evaluation result = evaluate(ring(15.0), ring(10.0));
  EXPECT_EQ(result.outcome, Outcome::Success);
  EXPECT_EQ(result.closed_loop, true);
  EXPECT_EQ(result.negative_margin, true);
  EXPECT_EQ(result.target_mm, 5.0);
  EXPECT_EQ(result.n_points, 377U);  // 2π · 15 / 0.25 = 376.99
  EXPECT_NEAR(result.abs_error_mm->mean, 0.0, kPolygonMm);
  EXPECT_NEAR(result.abs_error_mm->max, 0.0, kPolygonMm);
  EXPECT_NEAR(result.paper_abs_error_mm.value(), 0.5, kPolygonMm);
  EXPECT_EQ(result.paper_success, true);
  EXPECT_NEAR(result.centroid_shift_mm.value(), 0.0, 1e-9);
  EXPECT_NEAR(result.hu_score.value(), 0.0, 1e-6);
  EXPECT_EQ(result.close_margin->points, 0U);
  EXPECT_DOUBLE_EQ(result.coverage, 1.0);
}

TEST(Evaluate, APerfectInnerEdgeLiesOneElectrodeRadiusCloser) {
  const Evaluation result = evaluate(ring(14.5), ring(10.0), {.contour = ContourKind::InnerEdge});
  EXPECT_EQ(result.target_mm, 4.5);
  EXPECT_NEAR(result.abs_error_mm->max, 0.0, kPolygonMm);
  EXPECT_NEAR(result.paper_abs_error_mm.value(), 0.0, kPolygonMm);
}

TEST(Evaluate, AShiftedRingHasTheErrorsThatGeometrySays) {
  // Ring of radius 15 moved by 1: distance to a circle of 10 is |p| − 10, between 4 and 6.
  const Evaluation result = evaluate(ring(15.0, Vec3(1, 0, 0)), ring(10.0));
  EXPECT_NEAR(result.signed_error_mm->min, -1.0, 1e-3);
  EXPECT_NEAR(result.signed_error_mm->max, 1.0, 1e-3);
  EXPECT_NEAR(result.signed_error_mm->mean, 1.0 / 60.0, 1e-3);           // mean of |p| − 15 = s²/4R
  EXPECT_NEAR(result.abs_error_mm->mean, 2.0 / std::numbers::pi, 2e-3);  // of |cos|
  EXPECT_NEAR(result.signed_error_mm->sd, std::sqrt(0.5), 2e-3);         // of cos
  EXPECT_NEAR(result.centroid_shift_mm.value(), 1.0, 1e-9);
}

TEST(Evaluate, TellsWhereOnTheClockTheErrorsLie) {
  // Moved by 1 mm to the right of the picture: farther at 3 o'clock, closer at 9.
  const Evaluation result = evaluate(ring(15.0, Vec3(1, 0, 0)), ring(10.0));
  ASSERT_EQ(result.by_clock.size(), 12U);
  ASSERT_EQ(result.clock_h.size(), result.n_points);
  const double sector = std::sin(std::numbers::pi / 12.0) / (std::numbers::pi / 12.0);  // mean of cos over ±15 degrees
  EXPECT_EQ(result.by_clock[2].hour, 3);
  EXPECT_NEAR(result.by_clock[2].mean_mm.value(), sector, 0.01);
  EXPECT_NEAR(result.by_clock[8].mean_mm.value(), -sector, 0.02);
  EXPECT_NEAR(result.by_clock[11].mean_mm.value(), 0.0, 0.05);
  // The same cut with 12 o'clock to the right.
  const Evaluation turned = evaluate(ring(15.0, Vec3(1, 0, 0)), ring(10.0), {.twelve_o_clock = Vec3(1, 0, 0)});
  EXPECT_NEAR(turned.by_clock[11].mean_mm.value(), sector, 0.01);
  EXPECT_FALSE(validate(EvaluationSettings{.twelve_o_clock = Vec3(0, 0, 1)}).empty());
}

TEST(Evaluate, TheZonesOfThePaperBeginAtMinusFourAndAHalfAndMinusTwoPointThree) {
  for (const ContourKind kind : {ContourKind::InnerEdge, ContourKind::Centerline}) {
    const double radius = kind == ContourKind::InnerEdge ? 14.5 : 15.0;
    const Evaluation result = evaluate(ring(radius, Vec3(3, 0, 0)), ring(10.0), {.contour = kind});
    EXPECT_NEAR(result.positive_zone->at_or_below_mm, -4.5, 1e-12);
    EXPECT_NEAR(result.too_close_zone->at_or_below_mm, -2.3, 1e-12);
    EXPECT_EQ(result.positive_zone->points, 0U);
    EXPECT_EQ(result.too_close_zone->points, result.close_margin->points);
    EXPECT_GT(result.too_close_zone->points, 0U);
  }
  const Evaluation failed = evaluate(ring(14.5, Vec3(6, 0, 0)), ring(10.0), {.contour = ContourKind::InnerEdge});
  EXPECT_GT(failed.positive_zone->points, 0U);
  EXPECT_EQ(failed.positive_zone->points + failed.too_close_zone->points, failed.close_margin->points);
}

TEST(Evaluate, SeesAMissingArcThatTheErrorsDoNot) {
  Contour arc = ring(15.0);
  arc.points.resize(1080);  // the last quarter was not cut
  arc.is_closed = false;
  const Evaluation result = evaluate(arc, ring(10.0));
  EXPECT_NEAR(result.abs_error_mm->max, 0.0, kPolygonMm);
  EXPECT_NEAR(result.coverage, 0.75, 1e-3);
  ASSERT_TRUE(result.hausdorff.has_value());
  EXPECT_NEAR(result.hausdorff->from_first_mm, 0.0, 2e-3);
  EXPECT_NEAR(result.hausdorff->from_second_mm, 30.0 * std::sin(std::numbers::pi / 8.0), 0.05);
  EXPECT_EQ(result.by_clock[3].points, 0U);  // 4 o'clock: the last quarter lies between 3 and 6
  EXPECT_FALSE(result.by_clock[3].mean_mm.has_value());
}

TEST(Evaluate, APerfectOffsetHasNoHuExcessWhateverTheTumour) {
  Contour tumor;
  for (int k = 0; k < 720; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 720.0;
    tumor.points.emplace_back(10.0 * std::cos(angle), 8.0 * std::sin(angle), 0.0);
  }
  const EvaluationSettings settings{.contour = ContourKind::InnerEdge};
  const Evaluation perfect = evaluate(outer_offset(tumor, 4.5, kDown), tumor, settings);
  EXPECT_NEAR(perfect.hu_score.value(), 0.048, 1e-3);
  EXPECT_NEAR(perfect.hu_excess.value(), 0.0, 1e-12);
  EXPECT_NEAR(perfect.hu_score_to_ideal.value(), 0.0, 1e-12);
  EXPECT_NEAR(perfect.hausdorff->symmetric_mm(), 0.0, 1e-9);
  // A round cut about the same tumour is not the ideal one.
  const Evaluation round = evaluate(ring(14.5), tumor, settings);
  EXPECT_GT(round.hu_score_to_ideal.value(), 0.005);
  EXPECT_DOUBLE_EQ(round.hu_excess.value(), round.hu_score.value() - round.hu_score_ideal.value());
}

TEST(Evaluate, CountsCloseMarginsAsTissueLeftBesideTheTumour) {
  // A mid-line at 2.6 mm leaves 2.1 mm of tissue, one at 2.8 mm leaves 2.3.
  EXPECT_EQ(evaluate(ring(12.6), ring(10.0)).close_margin->fraction, 1.0);
  EXPECT_EQ(evaluate(ring(12.8), ring(10.0)).close_margin->fraction, 0.0);
  const EvaluationSettings inner{.contour = ContourKind::InnerEdge};
  EXPECT_EQ(evaluate(ring(12.1), ring(10.0), inner).close_margin->fraction, 1.0);
  EXPECT_EQ(evaluate(ring(12.3), ring(10.0), inner).close_margin->fraction, 0.0);
}

TEST(Evaluate, CallsACutIntoTheTumourAPositiveMargin) {
  const Evaluation result = evaluate(ring(15.0, Vec3(6, 0, 0)), ring(10.0));
  EXPECT_EQ(result.outcome, Outcome::PositiveMargin);
  EXPECT_EQ(result.negative_margin, false);
  EXPECT_NEAR(result.signed_error_mm->min, -6.0, 1e-2);
}

TEST(Evaluate, CallsAKerfWhoseWallReachesTheTumourAPositiveMargin) {
  EXPECT_EQ(evaluate(ring(10.4), ring(10.0)).outcome, Outcome::PositiveMargin);
  EXPECT_EQ(evaluate(ring(10.4), ring(10.0), {.contour = ContourKind::InnerEdge}).outcome, Outcome::Success);
}

TEST(Evaluate, SeesASpikeOfTheTumourThatReachesThroughTheRingBetweenTwoPoints) {
  Contour edge = ring(10.0);
  edge.points[360] = Vec3(0, 16, 0);  // one corner, far thinner than the step
  const Evaluation result = evaluate(ring(15.0), edge, {.step_mm = 2.0});
  EXPECT_EQ(result.negative_margin, false);
}

TEST(Evaluate, CallsARingBesideTheTumourAPositiveMargin) {
  const Evaluation result = evaluate(ring(5.0, Vec3(25, 0, 0)), ring(10.0));
  EXPECT_EQ(result.negative_margin, false);
  EXPECT_LT(result.coverage, 0.2);
}

TEST(Evaluate, MeasuresWhatThereIsOfAnOpenRing) {
  Contour open = ring(15.0);
  open.is_closed = false;
  open.points.resize(1081);  // three quarters
  const Evaluation result = evaluate(open, ring(10.0));
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
  EXPECT_EQ(result.closed_loop, false);
  EXPECT_EQ(result.paper_success, false);
  EXPECT_NEAR(result.coverage, 0.75, 1e-9);
  EXPECT_NEAR(result.abs_error_mm->max, 0.0, kPolygonMm);
  EXPECT_FALSE(result.hu_score.has_value());
  EXPECT_FALSE(result.centroid_shift_mm.has_value());
}

TEST(Evaluate, AnswersOpenLoopWhenNoMidLineWasFound) {
  const Evaluation result = evaluate(std::nullopt, testing::irregular_tumor());
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
  EXPECT_EQ(result.closed_loop, false);
  EXPECT_EQ(result.n_points, 0U);
  EXPECT_FALSE(result.negative_margin || result.abs_error_mm || result.paper_abs_error_mm || result.close_margin);
  EXPECT_GT(result.hu_score_ideal.value(), 0.0);
}

TEST(Evaluate, ThePapersSuccessIsAboutFourAndAHalfMillimetresOnEitherSide) {
  EXPECT_EQ(evaluate(ring(18.9), ring(10.0)).paper_success, true);   // 8.9 − 4.5 = 4.4
  EXPECT_EQ(evaluate(ring(19.1), ring(10.0)).paper_success, false);  // 9.1 − 4.5 = 4.6
}

TEST(Evaluate, APerfectOffsetScoresTheIdealHuScoreWhichIsNotZero) {
  const Contour edge = testing::irregular_tumor();
  const Evaluation result = evaluate(outer_offset(edge, 5.0, kDown), edge);
  EXPECT_GT(result.hu_score_ideal.value(), 0.03);
  EXPECT_NEAR(result.hu_score.value(), result.hu_score_ideal.value(), 1e-9);
  EXPECT_NEAR(result.abs_error_mm->max, 0.0, 0.01);
  EXPECT_GE(result.hu_score_seven.value(), result.hu_score.value());
}

TEST(Evaluate, DoesNotDependOnWhereTheRingStartsOrWhichWayItRuns) {
  const Contour edge = testing::irregular_tumor();
  const Contour cut = ring(14.0, Vec3(0.4, 0.2, 0.0));
  Contour other = cut;
  std::rotate(other.points.begin(), other.points.begin() + 500, other.points.end());
  std::reverse(other.points.begin(), other.points.end());
  const Evaluation a = evaluate(cut, edge);
  const Evaluation b = evaluate(other, edge);
  EXPECT_NEAR(a.abs_error_mm->mean, b.abs_error_mm->mean, 1e-4);
  EXPECT_NEAR(a.hu_score.value(), b.hu_score.value(), 1e-9);
  EXPECT_EQ(a.outcome, b.outcome);
}

TEST(Evaluate, TellsEveryViolationOfItsSettings) {
  const EvaluationSettings bad{
      .lateral_margin_mm = 0.2, .close_margin_mm = -1.0, .step_mm = std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THAT(sentences(validate(bad)),
              ::testing::ElementsAre(::testing::HasSubstr("close_margin_mm"), ::testing::HasSubstr("step_mm"),
                                     ::testing::HasSubstr("lateral_margin_mm")));
  EXPECT_THROW(static_cast<void>(evaluate(ring(15.0), ring(10.0), bad)), InvalidArgument);
}

}  // namespace
}  // namespace incise
