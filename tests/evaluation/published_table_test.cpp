#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/published_table.hpp>
#include <incise/evaluation/statistics.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

PrintedNumber printed(const char* text) {
  return printed_number(text).value();
}

PrintedGroup group(const char* mean, const char* sd, const char* max) {
  return {.name = "", .mean = printed(mean), .sd = printed(sd), .max = printed(max)};
}

std::vector<AuditRule> rules_of(const PrintedRow& row, const AuditSettings& settings = {}) {
  std::vector<AuditRule> rules;
  const Audit found = audit({row}, settings);
  for (const Finding& finding : found.rows.at(0).findings) {
    rules.push_back(finding.rule);
    EXPECT_FALSE(to_text(finding).empty());
  }
  return rules;
}

std::vector<AuditRule> rules_of(const PrintedGroup& total, const AuditSettings& settings = {}) {
  return rules_of(PrintedRow{.name = "row", .total = total, .parts = {}, .score_percent = {}}, settings);
}

TEST(PrintedNumber, KnowsItsLastPlace) {
  EXPECT_EQ(printed("1.20").value, 1.2);
  EXPECT_DOUBLE_EQ(printed("1.20").half_unit, 0.005);
  EXPECT_DOUBLE_EQ(printed("12").half_unit, 0.5);
  EXPECT_EQ(printed("-0.5").value, -0.5);
  for (const char* text : {"", "-", "1e3", "nan", "inf", "1.2.3", "1-2", "1,2", " 1", "0x1"}) {
    EXPECT_FALSE(printed_number(text).has_value()) << text;
  }
}

TEST(Audit, PassesWhateverNumbersReallyGive) {
  // Property: tables made from numbers, printed to one place, never hold an impossible row.
  Random random(1);
  std::vector<PrintedRow> rows;
  for (int k = 0; k < 300; ++k) {
    const std::size_t n = 2 + random.below(40);
    std::vector<double> all;
    PrintedRow row{.name = "made", .total = {}, .parts = {}, .score_percent = {}};
    const auto print = [&](const std::vector<double>& values) {
      const Summary summary = summarize(values);
      const auto rounded = [](double value) { return PrintedNumber{std::round(10.0 * value) / 10.0, 0.05}; };
      return PrintedGroup{.name = "",
                          .mean = rounded(summary.mean),
                          .sd = rounded(summary.sd),
                          .max = rounded(summary.max),
                          .min = rounded(summary.min),
                          .n = values.size()};
    };
    for (int part = 0; part < 2; ++part) {
      std::vector<double> values;
      const double scale = random.uniform(0.1, 3.0);
      const double power = random.uniform(0.5, 6.0);  // some pile up at 0 or have far outliers
      for (std::size_t i = 0; i < n; ++i) values.push_back(scale * std::pow(random.uniform(), power));
      row.parts.push_back(print(values));
      all.insert(all.end(), values.begin(), values.end());
    }
    row.total = print(all);
    rows.push_back(std::move(row));
  }
  for (const AuditedRow& row : audit(rows).rows) {
    EXPECT_THAT(row.findings, IsEmpty()) << to_text(row.findings.front());
  }
  for (PrintedRow& row : rows) {
    for (PrintedGroup& part : row.parts) part.n.reset();
  }
  for (const AuditedRow& row : audit(rows, {.n_at_least = 2}).rows) {
    EXPECT_THAT(row.findings, IsEmpty()) << "without n: " << to_text(row.findings.front());
  }
}

TEST(Audit, KnowsThatTheSpreadIsBoundByMeanAndMax) {
  // Half of many values at 0 and half at 2 have a mean of 1 and an sd of 1; nothing in [0, 2] has more.
  EXPECT_THAT(rules_of(group("1.00", "1.00", "2.00"), {.n_at_least = 1000}), IsEmpty());
  EXPECT_THAT(rules_of(group("1.00", "1.02", "2.00"), {.n_at_least = 1000}), ElementsAre(AuditRule::SdTooLarge));
  EXPECT_THAT(rules_of(group("1.00", "1.02", "2.00"), {.n_at_least = 10}), IsEmpty());  // √(10/9) more
  PrintedGroup bounded = group("1.00", "0.90", "2.00");
  bounded.min = printed("0.50");
  EXPECT_THAT(rules_of(bounded), ElementsAre(AuditRule::SdTooLarge));  // √(10/9 · 1 · 0.5) = 0.75
}

TEST(Audit, KnowsWhatTheGreatestValueAloneMakes) {
  PrintedGroup ten = group("0.50", "1.00", "6.00");
  ten.n = 10;
  EXPECT_THAT(rules_of(ten), ElementsAre(AuditRule::MeanTooSmall, AuditRule::SdTooSmall));  // 6/10 alone
  ten.mean = printed("1.00");
  ten.sd = printed("1.75");  // one at 6, the others at 4/9: sd = 5 √10 / 9 = 1.757
  EXPECT_THAT(rules_of(ten), IsEmpty());
  ten.sd = printed("1.70");
  EXPECT_THAT(rules_of(ten), ElementsAre(AuditRule::SdTooSmall));
}

TEST(Audit, KnowsThatOneValueIsItsOwnMeanAndMax) {
  PrintedGroup one = group("1.00", "0.00", "1.00");
  one.n = 1;
  EXPECT_THAT(rules_of(one), IsEmpty());
  one.sd = printed("0.50");
  EXPECT_THAT(rules_of(one), ElementsAre(AuditRule::SdTooLarge));
  one = group("1.00", "0.00", "2.00");
  one.n = 1;
  EXPECT_THAT(rules_of(one), ElementsAre(AuditRule::MeanTooSmall));
}

TEST(Audit, KnowsTheMeansThatCountsCanHave) {
  // By hand: of 28 whole numbers 5.18 can be the mean (145/28 = 5.179), the next is 146/28 = 5.214: 5.19 cannot.
  PrintedGroup counts{.name = "", .mean = printed("5.18"), .sd = printed("1.00"), .max = {}, .min = {}, .n = 28};
  EXPECT_THAT(rules_of(counts, {.grain = 1.0}), IsEmpty());
  counts.mean = printed("5.19");
  EXPECT_THAT(rules_of(counts, {.grain = 1.0}), ElementsAre(AuditRule::MeanNotOnGrain));
  EXPECT_THAT(rules_of(counts), IsEmpty());  // lengths are no counts
}

/// Means and counts that the R package scrutiny, which holds the authors' test, publishes as examples with its
/// verdicts.
TEST(Audit, AgreesWithPublishedVerdictsOnCounts) {
  struct Case {
    const char* mean;
    std::size_t n;
    bool is_possible;
  };
  for (const Case& c : {Case{"7.22", 32, true}, Case{"4.74", 25, false}, Case{"5.23", 29, false},
                        Case{"2.57", 24, false}, Case{"6.77", 27, false}, Case{"5.27", 43, false},
                        Case{"3.48", 20, false}, Case{"3.47", 15, true}, Case{"3.53", 10, false}}) {
    const PrintedGroup counts{
        .name = "", .mean = printed(c.mean), .sd = printed("1.00"), .max = {}, .min = {}, .n = c.n};
    EXPECT_EQ(rules_of(counts, {.grain = 1.0}).empty(), c.is_possible) << c.mean << " of " << c.n;
  }
}

TEST(Audit, KnowsTheOrderOfLeastMeanAndMax) {
  EXPECT_THAT(rules_of(group("1.2", "0.1", "1.0")), ElementsAre(AuditRule::MaxBelowMean));
  EXPECT_THAT(rules_of(group("1.2", "0.0", "1.1")), IsEmpty());  // 1.15 always, rounded
  EXPECT_THAT(rules_of(group("-0.2", "0.1", "1.0")), ElementsAre(AuditRule::MeanBelowLeast));
  EXPECT_THAT(rules_of(group("0.2", "-0.2", "1.0")), ElementsAre(AuditRule::NegativeSd));
  PrintedGroup high = group("1.0", "0.1", "2.0");
  high.min = printed("1.2");
  EXPECT_THAT(rules_of(high), ElementsAre(AuditRule::MinAboveMean));
}

TEST(Audit, KnowsWhatPoolingCanGive) {
  PrintedRow row{.name = "pooled", .total = group("0.8", "0.9", "9.0"), .parts = {}, .score_percent = {}};
  row.parts = {group("0.4", "0.9", "9.0"), group("0.6", "1.0", "9.0")};
  EXPECT_THAT(rules_of(row), ElementsAre(AuditRule::PooledMeanOutside));
  row.total = group("0.5", "0.9", "9.0");
  EXPECT_THAT(rules_of(row), IsEmpty());
  row.total = group("0.5", "1.3", "9.0");
  EXPECT_THAT(rules_of(row), ElementsAre(AuditRule::PooledSdTooLarge));
  row.total = group("0.5", "0.7", "9.0");
  EXPECT_THAT(rules_of(row), ElementsAre(AuditRule::PooledSdTooSmall));
  row.parts.pop_back();
  EXPECT_THAT(rules_of(row), IsEmpty());  // one part: nothing was pooled
}

PrintedGroup counted(const char* mean, const char* sd, std::size_t n) {
  PrintedGroup result = group(mean, sd, "9.0");
  result.max.reset();  // a greatest value of 9 would be another impossibility
  result.n = n;
  return result;
}

PrintedRow pooled(const PrintedGroup& total, const std::vector<PrintedGroup>& parts) {
  return {.name = "pooled", .total = total, .parts = parts, .score_percent = {}};
}

std::vector<std::string> unchecked_of(const PrintedRow& row) {
  const Audit found = audit({row});
  std::vector<std::string> result;
  for (const Unchecked& rule : found.rows.at(0).not_checkable) {
    const std::string name(to_string(rule.rule));
    if (name.starts_with("pooled")) result.push_back(name + ": " + rule.needs);
  }
  return result;
}

TEST(Audit, KnowsThePooledMeanWhereThePartsAreCounted) {
  // (10 · 1.0 + 30 · 3.0) / 40 = 2.5; rounding leaves 2.45 to 2.55, printed 2.4 at most 2.45, 2.3 at most 2.35.
  // Within: 9 · 0.04 + 29 · 0.04 = 1.52, between: 10 · 30 / 40 · 4 = 30, sd² = 31.52 / 39, sd = 0.899.
  const std::vector<PrintedGroup> parts{counted("1.0", "0.2", 10), counted("3.0", "0.2", 30)};
  EXPECT_THAT(rules_of(pooled(counted("2.5", "0.9", 40), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(counted("2.4", "0.9", 40), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(counted("2.3", "0.9", 40), parts)), ElementsAre(AuditRule::PooledMeanOff));
  const Audit found = audit({pooled(counted("2.0", "0.9", 40), parts)});
  ASSERT_EQ(found.rows[0].findings.size(), 1U);
  EXPECT_NEAR(found.rows[0].findings[0].bound, 2.45, 1e-12);
  EXPECT_THAT(rules_of(pooled(counted("2.5", "1.1", 40), parts)), ElementsAre(AuditRule::PooledSdTooLarge));
  EXPECT_THAT(rules_of(pooled(counted("2.5", "0.7", 40), parts)), ElementsAre(AuditRule::PooledSdTooSmall));
  EXPECT_THAT(unchecked_of(pooled(counted("2.5", "0.9", 40), parts)), IsEmpty());
}

PrintedGroup without_sd(PrintedGroup group) {
  group.sd.reset();
  return group;
}

TEST(Audit, APartOfOneValueNeedsNoSd) {
  // N = 31, mean (10 · 1 + 20 · 2 + 1 · 1) / 31 = 1.645. Within: 9 · 0.25 + 19 · 0.25 = 7; between: 10 · 0.645² +
  // 20 · 0.355² + 0.645² = 7.10; sd² = 14.10 / 30, sd = 0.686.
  std::vector<PrintedGroup> parts{counted("1.0", "0.5", 10), counted("2.0", "0.5", 20),
                                  without_sd(counted("1.0", "0", 1))};
  EXPECT_THAT(rules_of(pooled(counted("1.65", "0.69", 31), parts)), IsEmpty());
  EXPECT_THAT(unchecked_of(pooled(counted("1.65", "0.69", 31), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(counted("1.65", "0.69", 30), parts)), ElementsAre(AuditRule::PooledNOff));
  EXPECT_THAT(rules_of(pooled(counted("1.75", "0.69", 31), parts)), ElementsAre(AuditRule::PooledMeanOff));
  EXPECT_THAT(rules_of(pooled(counted("1.65", "0.90", 31), parts)), ElementsAre(AuditRule::PooledSdTooLarge));
  // At 50 the one value makes the mean 100 / 31 = 3.226 and, with 2267 between, sd² = 2274 / 30, sd = 8.71.
  parts[2].mean = printed("50");
  EXPECT_THAT(rules_of(pooled(counted("3.23", "8.7", 31), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(counted("3.23", "9.5", 31), parts)), ElementsAre(AuditRule::PooledSdTooLarge));
  EXPECT_THAT(rules_of(pooled(counted("3.23", "7.9", 31), parts)), ElementsAre(AuditRule::PooledSdTooSmall));
  // Its n follows from the others: 31 − 30 = 1.
  parts[2].n.reset();
  EXPECT_THAT(rules_of(pooled(counted("3.23", "8.7", 31), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(counted("3.23", "9.5", 31), parts)), ElementsAre(AuditRule::PooledSdTooLarge));
  // Nothing is counted at all: it may be one value, and the pooled mean lies between the parts'.
  for (PrintedGroup& part : parts) part.n.reset();
  EXPECT_THAT(rules_of(pooled(group("3.23", "8.7", "60.0"), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(group("0.70", "5.0", "60.0"), parts)), ElementsAre(AuditRule::PooledMeanOutside));
}

TEST(Audit, APartWithoutSdCountsWithItsNAndItsMean) {
  // (10 · 1 + 20 · 2 + 10 · 4) / 40 = 2.25. Between: 10 · 1.25² + 20 · 0.25² + 10 · 1.75² = 47.5, within at least 7:
  // sd >= √(54.5 / 39) = 1.18, however the third part's values stray.
  const std::vector<PrintedGroup> parts{counted("1.0", "0.5", 10), counted("2.0", "0.5", 20),
                                        without_sd(counted("4.0", "0", 10))};
  const auto needs_sd = ElementsAre("pooled_sd_too_large: sd of every part");
  for (const char* sd : {"1.2", "3.0"}) {
    EXPECT_THAT(rules_of(pooled(counted("2.25", sd, 40), parts)), IsEmpty()) << sd;
    EXPECT_THAT(unchecked_of(pooled(counted("2.25", sd, 40), parts)), needs_sd) << sd;
  }
  EXPECT_THAT(rules_of(pooled(counted("2.25", "1.0", 40), parts)), ElementsAre(AuditRule::PooledSdTooSmall));
  EXPECT_THAT(rules_of(pooled(counted("1.67", "1.2", 40), parts)), ElementsAre(AuditRule::PooledMeanOff));
  EXPECT_THAT(rules_of(pooled(counted("2.25", "1.2", 30), parts)), ElementsAre(AuditRule::PooledNOff));
  EXPECT_THAT(unchecked_of(pooled(without_sd(counted("2.25", "0", 40)), parts)),
              ElementsAre("pooled_sd_too_large: sd of the row", "pooled_sd_too_small: sd of the row"));
  const Audit found = audit({pooled(counted("2.25", "1.2", 40), parts)});
  std::vector<std::string> third;
  for (const Unchecked& rule : found.rows[0].not_checkable) {
    if (rule.needs == "sd") third.emplace_back(to_string(rule.rule));
  }
  EXPECT_THAT(third, ElementsAre("sd_too_large", "sd_too_small"));
}

TEST(Audit, KnowsThatCountsAddUp) {
  const std::vector<PrintedGroup> parts{counted("1.0", "0.2", 10), counted("3.0", "0.2", 10)};
  EXPECT_THAT(rules_of(pooled(counted("2.0", "1.0", 20), parts)), IsEmpty());
  const Audit found = audit({pooled(counted("2.0", "1.0", 25), parts)});
  ASSERT_EQ(found.rows[0].findings.size(), 1U);
  EXPECT_EQ(found.rows[0].findings[0].rule, AuditRule::PooledNOff);
  EXPECT_EQ(found.rows[0].findings[0].bound, 20.0);
  // One count is missing, and follows: 25 − 10 = 15, mean (10 + 45) / 25 = 2.2.
  std::vector<PrintedGroup> uncounted{parts[0], group("3.0", "0.2", "9.0")};
  EXPECT_THAT(rules_of(pooled(counted("2.2", "1.0", 25), uncounted)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(counted("2.0", "1.0", 25), uncounted)), ElementsAre(AuditRule::PooledMeanOff));
  EXPECT_THAT(rules_of(pooled(counted("1.0", "0.2", 10), uncounted)), ElementsAre(AuditRule::PooledNOff));
}

TEST(Audit, KnowsWhatTheMeansOfUncountedPartsAddToTheSpread) {
  // A pooled mean half way between 1.0 and 3.0 takes half of the values from each, whatever n: 1.0 alone from between.
  // For very many values sd² = 0.2² + 1² = 1.02²; rounding leaves (2.05 − 1.05)(2.95 − 2.05) + 0.15² = 0.960².
  const std::vector<PrintedGroup> parts{group("1.0", "0.2", "9.0"), group("3.0", "0.2", "9.0")};
  EXPECT_THAT(rules_of(pooled(group("2.0", "1.0", "9.0"), parts)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(group("2.0", "0.5", "9.0"), parts)), ElementsAre(AuditRule::PooledSdTooSmall));
  EXPECT_THAT(rules_of(pooled(group("2.0", "1.3", "9.0"), parts)), ElementsAre(AuditRule::PooledSdTooLarge));
  const Audit found = audit({pooled(group("2.0", "0.5", "9.0"), parts)});
  EXPECT_NEAR(found.rows[0].findings.at(0).bound, std::sqrt(0.9225), 1e-9);
  // 1.1 takes 5 % from the upper part: sd² = 0.04 + 0.1 · 1.9 = 0.23 = 0.48². A third part at 1.1 needs nothing from
  // it.
  EXPECT_THAT(rules_of(pooled(group("1.1", "1.0", "9.0"), parts)), ElementsAre(AuditRule::PooledSdTooLarge));
  std::vector<PrintedGroup> three = parts;
  three.push_back(group("2.0", "0.2", "9.0"));
  EXPECT_THAT(rules_of(pooled(group("2.0", "0.2", "9.0"), three)), IsEmpty());
  EXPECT_THAT(rules_of(pooled(group("2.0", "0.05", "9.0"), three)), ElementsAre(AuditRule::PooledSdTooSmall));
}

TEST(Audit, SaysWhatCannotBeChecked) {
  const std::vector<PrintedGroup> parts{group("1.0", "0.2", "9.0"), group("3.0", "0.2", "9.0")};
  EXPECT_THAT(unchecked_of(pooled(group("2.0", "1.0", "9.0"), parts)),
              ElementsAre("pooled_n_off: n of the row and of its parts", "pooled_mean_off: n of every part"));
  const std::vector<PrintedGroup> counts{counted("1.0", "0.2", 10), counted("3.0", "0.2", 10)};
  EXPECT_THAT(unchecked_of(pooled(group("2.0", "1.0", "9.0"), counts)),
              ElementsAre("pooled_n_off: n of the row and of its parts"));
  EXPECT_THAT(unchecked_of(pooled(counted("2.0", "1.0", 25), counts)),
              ElementsAre("pooled_mean_off: counts that agree"));
  const Audit alone =
      audit({PrintedRow{.name = "", .total = group("1.0", "0.2", "9.0"), .parts = {}, .score_percent = {}}});
  ASSERT_EQ(alone.rows[0].not_checkable.size(), 2U);
  EXPECT_EQ(alone.rows[0].not_checkable[0].rule, AuditRule::SdTooSmall);
  EXPECT_EQ(alone.rows[0].not_checkable[0].needs, "n");
}

TEST(Audit, FindsTheScoreThatFollowsFromNoCommonBaseline) {
  const auto row = [](const char* mean, const char* max, const char* percent) {
    return PrintedRow{
        .name = percent, .total = group(mean, "0.5", max), .parts = {}, .score_percent = printed(percent)};
  };
  // Baseline 2 mm: 0.75 · 1 + 0.25 · 2 = 1.25 mm, 62.5 %.
  const Audit found = audit({row("1.00", "2.00", "62.5"), row("2.00", "4.00", "125.0"), row("1.00", "2.00", "75.0"),
                             row("1.00", "2.00", "0.0")});
  EXPECT_EQ(found.impossible_rows, 1U);
  ASSERT_EQ(found.rows[2].findings.size(), 1U);
  EXPECT_EQ(found.rows[2].findings[0].rule, AuditRule::ScoreOffBaseline);
  EXPECT_NEAR(found.rows[2].findings[0].bound, 62.5, 0.6);
  EXPECT_EQ(found.rows_on_baseline, 2U);
  EXPECT_EQ(found.scored_rows, 3U);  // 0 % is a failure and says nothing about a baseline
  EXPECT_LE(found.baseline_mm->low_mm, 2.0);
  EXPECT_GE(found.baseline_mm->high_mm, 2.0);
}

TEST(Audit, TwoScoresThatContradictEachOtherLeaveOpenWhichIsWrong) {
  const auto row = [](const char* percent) {
    return PrintedRow{
        .name = percent, .total = group("1.00", "0.5", "2.00"), .parts = {}, .score_percent = printed(percent)};
  };
  const Audit found = audit({row("100.0"), row("50.0")});
  EXPECT_FALSE(found.baseline_mm.has_value());
  EXPECT_EQ(found.impossible_rows, 0U);
}

TEST(Audit, RefusesSettingsAndNumbersThatAreNone) {
  EXPECT_THROW(static_cast<void>(audit({}, {.n_at_least = 1})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(audit({}, {.grain = 0.0})), InvalidArgument);
  PrintedGroup broken = group("1.0", "1.0", "2.0");
  broken.mean.value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(rules_of(broken)), InvalidArgument);
}

TEST(Audit, IsToldInLines) {
  const AuditedRow impossible{.name = "A",
                              .findings = {{.rule = AuditRule::SdTooLarge, .group = "", .printed = 9.0, .bound = 5.0}},
                              .not_checkable = {{.rule = AuditRule::MeanNotOnGrain, .group = "", .needs = "n"}}};
  const AuditedRow possible{.name = "B",
                            .findings = {},
                            .not_checkable = {{.rule = AuditRule::MeanNotOnGrain, .group = "", .needs = "n"},
                                              {.rule = AuditRule::MeanNotOnGrain, .group = "part", .needs = "n"}}};
  const Audit found{.rows = {impossible, possible},
                    .impossible_rows = 1,
                    .baseline_mm = BaselineRange{.low_mm = 1.9, .high_mm = 2.1},
                    .rows_on_baseline = 2,
                    .scored_rows = 3};
  EXPECT_EQ(to_text(found), "A" + std::string(32, ' ') +
                                "sd 9 is more than mean and max allow, 5\n"
                                "not checkable in 2 of 2 rows: mean_not_on_grain (needs n)\n"
                                "1 of 2 rows impossible\n"
                                "score baseline 1.900 to 2.100 mm explains 2 of 3 rows\n");
  EXPECT_THAT(findings_by_rule(found), ElementsAre(std::pair{std::string("sd_too_large"), std::size_t{1}}));
}

}  // namespace
}  // namespace incise
