#include "support/contour_shapes.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/published_table_file.hpp>
#include <incise/storage/result_json.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;
using ::testing::ThrowsMessage;

nlohmann::ordered_json file_json(const Evaluation& evaluation) {
  nlohmann::ordered_json json = to_json(evaluation);
  json["points"] = points_json(evaluation);
  return json;
}

Evaluation shifted_ring() {
  return evaluate(testing::circle(15.0, 360, Vec3(1, 0, 0)), testing::circle(10.0, 360));
}

class EvaluationFileTest : public ::testing::Test {
 protected:
  EvaluationFile read(const nlohmann::ordered_json& json) {
    write_json(path(), json);
    return read_evaluation_file(path());
  }
  void expect_refused(const nlohmann::ordered_json& json, const char* place, const char* found) {
    EXPECT_THAT([&] { static_cast<void>(read(json)); },
                ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("s1.json"), HasSubstr(place), HasSubstr(found))));
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "s1.json"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(EvaluationFileTest, KeepsEveryErrorToTheLastBit) {
  const Evaluation evaluation = shifted_ring();
  const EvaluationFile file = read(file_json(evaluation));
  EXPECT_EQ(file.specimen.name, "s1");
  EXPECT_TRUE(file.specimen.is_ring);
  EXPECT_EQ(file.specimen.signed_error_mm, evaluation.errors.signed_error_mm);
  EXPECT_EQ(file.clock_h, evaluation.clock_h);
  EXPECT_EQ(file.outcome, Outcome::Success);
  EXPECT_EQ(file.contour, ContourKind::Centerline);
  EXPECT_EQ(file.target_mm, 5.0);
  EXPECT_EQ(file.hu_score, evaluation.hu_score);
  EXPECT_NEAR(file.too_close_at_mm.value(), -2.3, 1e-12);
}

TEST_F(EvaluationFileTest, ArclengthsRunFromTheFirstPointInEvenSteps) {
  const auto json = points_json(shifted_ring());
  EXPECT_EQ(json["arclength_mm"][0], 0.0);
  EXPECT_NEAR(json["arclength_mm"][10].get<double>(), 2.5, 0.01);
  EXPECT_EQ(json["x_mm"].size(), json["signed_error_mm"].size());
}

TEST_F(EvaluationFileTest, WithoutAnIncisionHasNoErrors) {
  const EvaluationFile file = read(file_json(evaluate(std::nullopt, testing::circle(10.0, 360))));
  EXPECT_TRUE(file.specimen.signed_error_mm.empty());
  EXPECT_EQ(file.outcome, Outcome::OpenLoop);
  EXPECT_FALSE(file.too_close_at_mm.has_value());
}

TEST_F(EvaluationFileTest, ASuccessHasPointsAndNoOpenRing) {
  nlohmann::ordered_json json = file_json(shifted_ring());
  json["n_points"] = 0;
  expect_refused(json, "/n_points", "0 with the outcome success");
  json = file_json(shifted_ring());
  json["closed_loop"] = false;
  expect_refused(json, "/closed_loop", "false with the outcome success");
}

TEST_F(EvaluationFileTest, HoldsDistancesOfSpecimensOnlyAndAnOutcomeByName) {
  nlohmann::ordered_json json = file_json(shifted_ring());
  json["points"]["signed_error_mm"][3] = 1e200;  // its square is no number
  expect_refused(json, "/points/signed_error_mm", "1e+200");
  json = file_json(shifted_ring());
  json["outcome"] = 4;
  expect_refused(json, "outcome", "4");
}

TEST_F(EvaluationFileTest, HoldsATargetWithinABody) {
  nlohmann::ordered_json json = file_json(shifted_ring());
  json["target_mm"] = 1e300;
  expect_refused(json, "target_mm", "1e+300");
}

TEST_F(EvaluationFileTest, ThatIsDamagedIsRefusedWithThePlace) {
  const nlohmann::ordered_json good = file_json(shifted_ring());
  nlohmann::ordered_json json = good;
  json.erase("points");
  expect_refused(json, "points", "no such key");
  json = good;
  json["points"]["signed_error_mm"][7] = "wide";
  expect_refused(json, "/points/signed_error_mm", "wide");
  json = good;
  json["points"]["signed_error_mm"].erase(0);
  expect_refused(json, "/points/signed_error_mm", "numbers");
  json = good;
  json["points"]["clock_h"][0] = 13.0;
  expect_refused(json, "/points/clock_h", "13");
  json = good;
  json["target_mm"] = nullptr;
  expect_refused(json, "target_mm", "null");
  json = good;
  json["outcome"] = "splendid";
  expect_refused(json, "outcome", "splendid");
  expect_refused(nlohmann::ordered_json::array(), "/", "expected an object");
}

class PublishedTableTest : public ::testing::Test {
 protected:
  std::vector<PrintedRow> read(const std::string& text) {
    std::ofstream(path(), std::ios::binary) << text;
    return read_published_table(path()).rows;
  }
  void expect_refused(const std::string& text, const char* what) {
    EXPECT_THAT([&] { static_cast<void>(read(text)); },
                ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("table.csv"), HasSubstr(what))));
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "table.csv"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(PublishedTableTest, IsReadWithItsPartsAndItsFailures) {
  const auto rows = read(
      "speed,\"kind, of\",a_mean_mm,a_sd_mm,mean_mm,sd_mm,max,n\n1,\"x, "
      "y\",1.30,0.6,1.2,1.0,2.6,40\n2,z,failure,-,,-,4.0,\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].name, "speed 1, kind, of x, y");
  EXPECT_EQ(rows[0].parts.at(0).name, "a");
  EXPECT_DOUBLE_EQ(rows[0].parts[0].mean.half_unit, 0.005);
  EXPECT_EQ(rows[0].total->n, 40U);
  EXPECT_EQ(rows[0].total->max->value, 2.6);
  EXPECT_FALSE(rows[1].total.has_value());
  EXPECT_TRUE(rows[1].parts.empty());
}

TEST_F(PublishedTableTest, KeepsASetWithoutSd) {
  const auto rows = read(
      "name,mean_mm,sd_mm,n,a_mean_mm,a_sd_mm,a_n,b_mean_mm,b_sd_mm,b_n,c_mean_mm,c_sd_mm,c_n\n"
      "near,1.65,0.69,31,1.0,0.5,10,2.0,0.5,20,1.0,-,1\n"
      "far,3.23,8.7,31,1.0,0.5,10,2.0,0.5,20,50,,1\n");
  for (const PrintedRow& row : rows) {
    ASSERT_EQ(row.parts.size(), 3U) << row.name;
    EXPECT_FALSE(row.parts[2].sd.has_value()) << row.name;
    EXPECT_EQ(row.parts[2].n, 1U) << row.name;
  }
  EXPECT_EQ(audit(rows).impossible_rows, 0U);
}

TEST_F(PublishedTableTest, ThatIsDamagedIsRefusedWithThePlace) {
  expect_refused("", "an empty file");
  expect_refused("mean_mm,sd_mm\n", "without rows");
  expect_refused("mean_mm,max_mm\n1,2\n", "mean_mm and sd_mm");
  expect_refused("mean_mm,sd_mm,a_mean_mm\n1,2,3\n", "a_sd_mm");
  expect_refused("mean_mm,sd_mm,a_max_mm\n1,2,3\n", "a_mean_mm");
  expect_refused("mean_mm,sd_mm,mean\n1,2,3\n", "one column for each");
  expect_refused("mean_mm,sd_mm\n1,wide\n", "line 2, column sd_mm");
  expect_refused("mean_mm,sd_mm\n1,2,3\n", "line 2");
  expect_refused("mean_mm,sd_mm,n\n1,2,3.5\n", "whole number");
  expect_refused("mean_mm,mean_mm\n1,2\n", "more than once");
  expect_refused("mean_mm,sd_mm,note\n1,2,\"open\n", "quote");
}

TEST_F(PublishedTableTest, HoldsNoMoreRowsThanMemoryHoldsOfAnyTable) {
  std::string text = "mean_mm,sd_mm\n";
  for (int row = 0; row < 100'001; ++row) text += "1.2,0.3\n";
  expect_refused(text, "line 100002: found more than 100000 rows of 2 columns, expected at most 200000 cells");
}

std::vector<PrintedRow> published(const char* name) {
  return read_published_table(std::filesystem::path(INCISE_SOURCE_DIR) / "data/published_tables" / name).rows;
}

std::size_t rows_with(const Audit& audit, AuditRule rule, const char* group) {
  return static_cast<std::size_t>(std::count_if(audit.rows.begin(), audit.rows.end(), [&](const AuditedRow& row) {
    return std::any_of(row.findings.begin(), row.findings.end(),
                       [&](const Finding& finding) { return finding.rule == rule && finding.group == group; });
  }));
}

TEST(PaperTableOne, ScoresFollowFromThePrintedColumnsWithOneBaseline) {
  const auto rows = published("table_1.csv");
  ASSERT_EQ(rows.size(), 25U);
  const Audit found = audit(rows);
  EXPECT_EQ(found.scored_rows, 20U);
  EXPECT_EQ(found.rows_on_baseline, 20U);
  EXPECT_NEAR(found.baseline_mm->low_mm, 1.925, 5e-4);
  EXPECT_NEAR(found.baseline_mm->high_mm, 1.950, 5e-4);
  const double baseline = 0.5 * (found.baseline_mm->low_mm + found.baseline_mm->high_mm);
  int failures = 0;
  for (const PrintedRow& row : rows) {
    if (!row.total) {
      EXPECT_EQ(row.score_percent->value, registration_percent(std::nullopt, baseline)) << row.name;
      ++failures;
      continue;
    }
    // Mean and max are rounded to ±0.05 mm, which is ±0.05 mm of score.
    const double score = registration_score_mm(row.total->mean.value, row.total->max->value);
    EXPECT_NEAR(registration_percent(score, baseline), row.score_percent->value, 100.0 * 0.05 / baseline + 0.05)
        << row.name;
  }
  EXPECT_EQ(failures, 5);
}

TEST(PaperTableOne, HoldsRowsThatCannotBe) {
  const Audit found = audit(published("table_1.csv"));
  EXPECT_EQ(rows_with(found, AuditRule::SdTooLarge, "s1"), 3U);
  EXPECT_EQ(rows_with(found, AuditRule::SdTooLarge, "s2"), 16U);
  EXPECT_EQ(rows_with(found, AuditRule::SdTooLarge, ""), 3U);
  EXPECT_EQ(rows_with(found, AuditRule::PooledMeanOutside, ""), 1U);  // speed 17, dullness 5: 0.8 of 0.4 and 0.6
  EXPECT_EQ(rows_with(found, AuditRule::PooledSdTooLarge, ""), 1U);   // speed 9, dullness 1: 2.3 of 0.4 and 1.8
}

TEST(PaperTableOne, HasAsManyImpossibleRowsAsTheDocumentationSays) {
  EXPECT_EQ(audit(published("table_1.csv")).impossible_rows, 16U);
  EXPECT_EQ(audit(published("table_1.csv"), {.n_at_least = 30}).impossible_rows, 18U);
}

TEST(PaperTableTwo, IsPossible) {
  EXPECT_EQ(audit(published("table_2.csv")).impossible_rows, 0U);
}

TEST(PaperSimulatedIncisions, SpreadMoreThanTheirOwnBorderOfSuccessAllows) {
  const Audit found = audit(published("simulated_incisions.csv"));
  EXPECT_EQ(found.impossible_rows, 2U);
  EXPECT_EQ(rows_with(found, AuditRule::SdTooLarge, "s_a"), 1U);
  EXPECT_EQ(rows_with(found, AuditRule::PooledSdTooSmall, ""), 2U);
}

}  // namespace
}  // namespace incise
