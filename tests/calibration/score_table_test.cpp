#include <incise/calibration/score_table.hpp>
#include <incise/core/error.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

CalibrationRun scored(double mean, double max, double inner_mean = 1.0, double inner_max = 2.0) {
  CalibrationRun run;
  run.outcome = Outcome::Success;
  run.closed_loop = true;
  run.paper_success = true;
  run.paper_abs_error_mm = Summary{mean, 0.5, 0.0, max};
  run.signed_error_mm = Summary{-mean, 0.5, -max, 0.0};
  run.inner_signed_error_mm = Summary{-inner_mean, 0.5, -inner_max, 0.0};
  run.inner_abs_error_mm = Summary{inner_mean, 0.5, 0.0, inner_max};
  return run;
}

CalibrationRun open_ring() {
  CalibrationRun run{.outcome = Outcome::OpenLoop};
  return run;
}

// The paper's rows: 13 x 9 (1.7 and 1.4 mm, greatest 3.3), 9 x 9 (0.6 and 0.7, 1.9), 17 x 9 (1.1 and a failure).
const std::vector<CalibrationRun> kFirst{scored(1.7, 3.3), scored(0.6, 1.9), scored(1.1, 2.3)};
const std::vector<CalibrationRun> kSecond{scored(1.4, 2.9), scored(0.7, 1.5), open_ring()};

const std::vector<PhotographedErrors> kTwo{{1.5, 2.1}, {1.9, 2.6}};
const std::vector<PhotographedErrors> kOne{{1.5, 2.1}};

TEST(ScoreTable, ScoresThePapersRowsAsThePaperDoes) {
  // The two photographed tongues: means 1.57 and 1.91 mm (Table II), and the greatest that the table's scores need.
  const std::vector<PhotographedErrors> photographs{{1.57, 2.2}, {1.91, 2.58}};
  const double baseline = baseline_mm(photographs);
  EXPECT_NEAR(baseline, 0.75 * 1.74 + 0.25 * 2.58, 1e-12);
  const ScoreTable table = score_table({kFirst, kSecond}, photographs);
  EXPECT_NEAR(table.rows[0].percent, 100.0 * (0.75 * 1.55 + 0.25 * 3.3) / baseline, 1e-9);
  EXPECT_NEAR(table.rows[0].percent, 103.6, 2.0);  // printed, from rounded numbers
  EXPECT_NEAR(table.rows[1].percent, 49.3, 2.0);
  EXPECT_EQ(table.chosen, 0U);
}

TEST(ScoreTable, AFailureScoresNothingAndIsNeverChosen) {
  const ScoreTable table = score_table({kFirst, kSecond}, kTwo);
  EXPECT_TRUE(table.rows[2].is_failure);
  EXPECT_EQ(table.rows[2].percent, 0.0);
  EXPECT_EQ(table.rows[2].inner_specimens, 1U);
  // Of the one that closed, against its own photograph and not that of both.
  EXPECT_NEAR(table.rows[2].inner_percent.value(), 100.0 * (0.75 * 1.0 + 0.25 * 2.0) / (0.75 * 1.5 + 0.25 * 2.1), 1e-9);
  EXPECT_FALSE(score_table({{open_ring()}}, kOne).rows[0].inner_percent);
  EXPECT_NEAR(table.rows[2].mean_abs_mm.value(), 1.1, 1e-12);  // of the specimen that closed
  EXPECT_FALSE(score_table({{open_ring()}}, kOne).chosen);
}

TEST(ScoreTable, APointFartherOffThanThePaperAllowsIsAFailure) {
  CalibrationRun far = scored(1.5, 4.6);
  far.paper_success = false;
  EXPECT_TRUE(score_table({{far}}, kOne).rows[0].is_failure);
}

TEST(ScoreTable, ComparesInnerEdgesWithInnerEdgesBesideThePapersScore) {
  const ScoreTable table = score_table({{scored(0.2, 0.4, 1.6, 2.8)}, {scored(0.3, 0.5, 1.4, 3.2)}}, kTwo);
  EXPECT_NEAR(table.rows[0].inner_percent.value(), 100.0 * (0.75 * 1.5 + 0.25 * 3.2) / baseline_mm(kTwo), 1e-9);
  EXPECT_NEAR(table.rows[0].mean_inner_signed_mm.value(), -1.5, 1e-12);
  EXPECT_LT(table.rows[0].percent, 20.0);
}

TEST(ScoreTable, RefusesASuccessWithoutErrors) {
  CalibrationRun run = scored(1.0, 2.0);
  run.paper_abs_error_mm.reset();
  EXPECT_THROW(static_cast<void>(score_table({{run}}, kOne)), InvalidArgument);
}

TEST(ScoreTable, RefusesListsOfDifferentLength) {
  EXPECT_THROW(static_cast<void>(score_table({kFirst, {open_ring()}}, kTwo)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(score_table({}, {})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(score_table({kFirst, kSecond}, kOne)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(baseline_mm({})), InvalidArgument);
}

}  // namespace
}  // namespace incise
