#include <incise/core/error.hpp>
#include <incise/core/verdict.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Verdict, IsOkWithoutAReason) {
  const Verdict verdict;
  EXPECT_EQ(verdict.status(), VerdictStatus::Ok);
  EXPECT_TRUE(gate_of(verdict, {}).is_open);
}

TEST(Verdict, ListsTheWorstReasonFirstWhateverTheOrderInWhichTheyCome) {
  Verdict verdict;
  verdict.add("mesh_resolution", 2.1, "coarse");
  verdict.add("depth", 0.5, "shallow");
  verdict.add("tumor_distance", -1.66, "into the tumour");
  std::vector<std::string> ids;
  for (const VerdictReason& reason : verdict.reasons()) ids.push_back(reason.id);
  EXPECT_THAT(ids, ElementsAre("tumor_distance", "depth", "mesh_resolution"));
  EXPECT_EQ(verdict.status(), VerdictStatus::Refused);
}

TEST(Verdict, TakesSeverityUnitAndLimitFromTheTable) {
  Verdict verdict;
  verdict.add("tumor_distance", 1.0, "near");
  verdict.add("lateral_margin", 2.9, "near", {}, 3.0);
  ASSERT_EQ(verdict.reasons().size(), 2U);
  EXPECT_EQ(verdict.reasons()[0].limit, 2.2);
  EXPECT_EQ(verdict.reasons()[0].unit, "mm");
  EXPECT_EQ(verdict.reasons()[1].limit, 3.0);
  EXPECT_THROW(verdict.add("nonsense", 1.0, "x"), InvalidArgument);
}

TEST(Verdict, HoldsAReasonOnce) {
  Verdict one;
  one.add("depth", 0.5, "shallow");
  Verdict both = one;
  both.add(one);
  EXPECT_EQ(both.reasons().size(), 1U);
}

TEST(VerdictGate, OpensForCautionsOnlyWhenEachIsAcceptedByName) {
  Verdict verdict;
  verdict.add("depth", 0.5, "shallow");
  verdict.add("heat", -0.1, "hot");
  const std::vector<std::string> one{"depth"};
  const std::vector<std::string> both{"heat", "depth"};
  EXPECT_FALSE(gate_of(verdict, one).is_open);
  EXPECT_THAT(gate_of(verdict, one).missing, ElementsAre("heat"));
  EXPECT_TRUE(gate_of(verdict, both).is_open);
  EXPECT_THAT(gate_of(verdict, both).accepted, ElementsAre("depth", "heat"));
}

TEST(VerdictGate, NeverOpensForARefusal) {
  for (const VerdictRule& rule : verdict_rules()) {
    if (rule.severity != VerdictStatus::Refused) continue;
    Verdict verdict;
    verdict.add(rule.id, {}, "no");
    const std::vector<std::string> all{std::string(rule.id)};
    EXPECT_FALSE(gate_of(verdict, all).is_open) << rule.id;
    EXPECT_THAT(gate_of(verdict, all).accepted, IsEmpty()) << rule.id;
  }
}

TEST(VerdictRules, HaveIdsOfTheirOwnAndAMeaning) {
  std::set<std::string_view> ids;
  for (const VerdictRule& rule : verdict_rules()) {
    EXPECT_TRUE(ids.insert(rule.id).second) << rule.id;
    EXPECT_NE(rule.severity, VerdictStatus::Ok) << rule.id;
    EXPECT_EQ(rule.meaning.back(), '.') << rule.id;
    EXPECT_EQ(rule.limit.has_value(), !rule.relation.empty()) << rule.id;
  }
}

/// The row that docs/models/verdict.md has for a rule.
std::string row_of(const VerdictRule& rule) {
  const std::string good = rule.limit ? fmt::format("{} {:g}", rule.relation, *rule.limit) : "–";
  return fmt::format("| `{}` | {} | {} | {} | {} |", rule.id, to_string(rule.severity), good, rule.unit.empty() ? "–" : rule.unit, rule.meaning);
}

TEST(VerdictRules, StandInTheDocumentationAsTheyAreInTheLibrary) {
  std::ifstream page(std::string(INCISE_SOURCE_DIR) + "/docs/models/verdict.md");
  ASSERT_TRUE(page);
  std::vector<std::string> found;
  for (std::string line; std::getline(page, line);) {
    const bool is_rule = line.starts_with("| `") && std::count(line.begin(), line.end(), '|') == 6;
    if (is_rule) found.push_back(line);
  }
  std::vector<std::string> expected;
  for (const VerdictRule& rule : verdict_rules()) expected.push_back(row_of(rule));
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace incise
