#include "laboratory/factor_table.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise::laboratory {
namespace {

using ::testing::IsEmpty;

constexpr std::size_t kDirections = 36;
constexpr double kNoiseMm = 0.02;

struct KnownCuts {
  FractionalFactorial design{5};
  std::vector<std::string> names{"creep", "drift", "wander", "idle", "power"};
  std::vector<std::vector<std::optional<ErrorByDirection>>> errors;
  std::vector<std::vector<std::optional<double>>> means;

  void measure(std::size_t s, std::size_t run, std::optional<ErrorByDirection> errors_mm) {
    double sum = 0.0;
    if (errors_mm)
      for (const double error : *errors_mm) sum += std::abs(error) / static_cast<double>(kDirections);
    means[s][run] = errors_mm ? std::optional(sum) : std::nullopt;
    errors[s][run] = std::move(errors_mm);
  }
};

/// Creep moves each ring inwards by 0.4 mm; drift shifts one to a side by 0.6 mm and the next to the other; wander adds
/// a wave of order 3 and amplitude 0.5 mm.
KnownCuts known_cuts() {
  KnownCuts cuts;
  Random random(5);
  for (std::size_t s = 0; s < 4; ++s) {
    cuts.errors.emplace_back(cuts.design.runs());
    cuts.means.emplace_back(cuts.design.runs());
    for (std::size_t run = 0; run < cuts.design.runs(); ++run) {
      const double creep = cuts.design.is_on(run, 0) ? -0.4 : 0.0;
      const double drift = cuts.design.is_on(run, 1) ? (s % 2 == 0 ? 0.6 : -0.6) : 0.0;
      const double wander = cuts.design.is_on(run, 2) ? 0.5 : 0.0;
      ErrorByDirection errors;
      for (std::size_t i = 0; i < kDirections; ++i) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kDirections);
        errors.push_back(-2.0 - 0.1 * static_cast<double>(s) + creep + drift * std::cos(angle) +
                         wander * std::sin(3.0 * angle) + kNoiseMm * random.normal());
      }
      cuts.measure(s, run, errors);
    }
  }
  return cuts;
}

FactorTable table_of(const KnownCuts& cuts) {
  return factor_table(cuts.design, cuts.names, cuts.errors, cuts.means);
}

TEST(FactorTable, TellsWhatEachFactorMoves) {
  const FactorTable table = table_of(known_cuts());
  ASSERT_EQ(table.factors.size(), 5U);
  EXPECT_EQ(table.factors[1].factor, "drift");
  EXPECT_NEAR(table.factors[0].moved->level_mm, 0.4, 0.01);
  EXPECT_NEAR(table.factors[1].moved->shift_mm, 0.6, 0.02);  // though it goes to both sides
  EXPECT_NEAR(table.factors[2].moved->rest_mm, 0.5 / std::sqrt(2.0), 0.02);
  EXPECT_LT(table.factors[0].moved->shift_mm, 0.03);
  EXPECT_LT(table.factors[3].moved->level_mm, 0.01);
  EXPECT_LT(table.factors[4].moved->rest_mm, 0.04);
  // Two means of eight cuts each; one number for a mean of 36 directions.
  EXPECT_NEAR(table.chance->rest_mm, kNoiseMm * std::sqrt(2.0 / 8.0), 0.003);
  EXPECT_NEAR(table.chance->level_mm, kNoiseMm * std::sqrt(2.0 / 8.0 / 36.0), 0.0008);
}

TEST(FactorTable, TheMeanErrorChangesByWhatIsKnown) {
  const FactorTable table = table_of(known_cuts());
  ASSERT_TRUE(table.factors[0].change_mm && table.factors[0].change_95);
  EXPECT_NEAR(*table.factors[0].change_mm, 0.4, 0.01);  // the error is inwards: it grows
  EXPECT_LT(table.factors[0].change_95->low, 0.4);
  EXPECT_GT(table.factors[0].change_95->high, 0.39);
  EXPECT_NEAR(*table.factors[3].change_mm, 0.0, 0.01);
}

TEST(FactorTable, PairsAreJudgedByHowSpecimensDiffer) {
  KnownCuts cuts = known_cuts();
  const auto add_where_alike = [&](const FractionalFactorial::Pair& pair, const std::vector<double>& by_specimen) {
    for (std::size_t s = 0; s < cuts.errors.size(); ++s)
      for (std::size_t run = 0; run < cuts.design.runs(); ++run)
        if (cuts.design.is_alike(run, pair)) *cuts.means[s][run] += by_specimen[s];
  };
  add_where_alike({0, 1}, {0.25, 0.30, 0.35, 0.30});
  add_where_alike({2, 3}, {0.60, -0.60, 0.55, -0.55});  // as much either way
  const FactorTable table = table_of(cuts);
  const auto has = [](const PairEffect& effect, const std::string& a, const std::string& b) {
    return std::ranges::find(effect.pairs, std::pair(a, b)) != effect.pairs.end();
  };
  ASSERT_FALSE(table.pairs.empty());
  const PairEffect& first = table.pairs.front();
  EXPECT_TRUE(has(first, "creep", "drift"));
  EXPECT_NEAR(first.change_mm, 0.30, 0.02);
  ASSERT_TRUE(first.p && first.change_95);
  EXPECT_LT(*first.p, 0.05);
  EXPECT_LT(first.change_95->low, 0.30);
  for (const PairEffect& effect : table.pairs) {
    if (!has(effect, "wander", "idle")) continue;
    EXPECT_NEAR(effect.change_mm, 0.0, 0.02);
    EXPECT_EQ(effect.p, 1.0) << "great in each specimen, none on average";
  }
}

TEST(FactorTable, OpenRingsAreCountedAndLeftOut) {
  KnownCuts cuts = known_cuts();
  for (std::size_t run = 0; run < cuts.design.runs(); ++run)
    if (cuts.design.is_on(run, 4)) cuts.measure(1, run, std::nullopt);
  cuts.measure(2, 3, std::nullopt);
  const FactorTable table = table_of(cuts);
  EXPECT_EQ(table.cuts, 64U);
  EXPECT_EQ(table.measured, 64U - 8U - 1U);
  EXPECT_EQ(table.estimated, (std::vector<std::size_t>{0, 2, 3}));  // the second was never measured with power
  EXPECT_EQ(table.factors[4].made_with, 32U);
  EXPECT_EQ(table.factors[4].made_without, 32U);
  EXPECT_EQ(table.factors[4].measured_with + table.factors[4].measured_without, table.measured);
  EXPECT_NEAR(table.factors[0].moved->level_mm, 0.4, 0.02);
}

TEST(FactorTable, SaysNothingWithoutMeasuredCuts) {
  KnownCuts cuts = known_cuts();
  for (std::size_t s = 0; s < cuts.errors.size(); ++s)
    for (std::size_t run = 0; run < cuts.design.runs(); ++run) cuts.measure(s, run, std::nullopt);
  const FactorTable table = table_of(cuts);
  EXPECT_EQ(table.measured, 0U);
  EXPECT_THAT(table.estimated, IsEmpty());
  EXPECT_THAT(table.pairs, IsEmpty());
  EXPECT_FALSE(table.factors[0].change_mm || table.factors[0].moved || table.chance);
}

TEST(FactorTable, RefusesListsThatDoNotGoTogether) {
  KnownCuts cuts = known_cuts();
  cuts.errors[0][0]->pop_back();
  EXPECT_THROW((void)table_of(cuts), InvalidArgument);
  cuts = known_cuts();
  (*cuts.errors[0][0])[0] = std::nan("");
  EXPECT_THROW((void)table_of(cuts), InvalidArgument);
  cuts = known_cuts();
  cuts.names.pop_back();
  EXPECT_THROW((void)table_of(cuts), InvalidArgument);
}

}  // namespace
}  // namespace incise::laboratory
