#include <incise/calibration/power_choice.hpp>
#include <incise/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr PowerLimits kLimits{.bulge_limit_mm = 1.2, .damage_limit_mm = 1.0};

PowerCut closed(const char* specimen, double power_w, double bulge_mm, double thermal_mm) {
  PowerCut cut;
  cut.specimen = specimen;
  cut.power_w = power_w;
  cut.speed_mm_s = 7.0;
  cut.outcome = Outcome::Success;
  cut.bulge_mm = bulge_mm;
  cut.thermal_width_mm = thermal_mm;
  cut.mean_abs_error_mm = 1.5;
  return cut;
}

PowerCut open_ring(const char* specimen, double power_w) {
  PowerCut cut = closed(specimen, power_w, 0.5, 0.5);
  cut.outcome = Outcome::OpenLoop;
  cut.mean_abs_error_mm.reset();
  return cut;
}

/// As in the paper: bulging at 25 and 30 W, none at 35, damage at 40.
std::vector<PowerCut> papers_series() {
  return {closed("a", 25, 1.7, 0.67), closed("a", 30, 1.4, 0.81), closed("a", 35, 1.1, 0.94),
          closed("a", 40, 0.6, 1.08), closed("b", 25, 1.3, 0.66), closed("b", 30, 1.0, 0.80),
          closed("b", 35, 0.8, 0.93), closed("b", 40, 0.5, 1.06)};
}

std::optional<double> chosen_of(const std::vector<PowerCut>& cuts) {
  return choose_power(cuts, kLimits).chosen_w;
}

TEST(ChoosePower, OfThePapersSeriesIsThePapersWithAReasonAgainstEachOther) {
  const PowerChoice choice = choose_power(papers_series(), kLimits);
  EXPECT_EQ(choice.chosen_w, 35.0);
  ASSERT_EQ(choice.powers.size(), 4U);
  EXPECT_THAT(choice.powers[0].reasons, ElementsAre(HasSubstr("a: skin bulges by 1.70 mm")));
  EXPECT_THAT(choice.powers[1].reasons, ElementsAre(HasSubstr("a: skin bulges by 1.40 mm, more than 1.2 mm")));
  EXPECT_THAT(choice.powers[2].reasons, IsEmpty());
  EXPECT_THAT(choice.powers[3].reasons, ElementsAre(HasSubstr("a: heat reaches 1.08 mm")));
  EXPECT_EQ(choice.powers[1].greatest_bulge_mm, 1.4);
  EXPECT_EQ(choice.powers[3].greatest_thermal_width_mm, 1.08);
}

TEST(ChoosePower, OneSpecimenThatBulgesIsEnoughAndTheOrderOfCutsIsNone) {
  std::vector<PowerCut> cuts = papers_series();
  cuts[6].bulge_mm = 1.21;  // b at 35 W
  EXPECT_FALSE(chosen_of(cuts));
  cuts = papers_series();
  std::reverse(cuts.begin(), cuts.end());
  EXPECT_EQ(chosen_of(cuts), 35.0);
}

TEST(ChoosePower, AnOpenRingSpeaksAgainstAPowerThatLeavesSkinFlat) {
  const PowerChoice choice =
      choose_power(std::vector<PowerCut>{open_ring("a", 30), closed("a", 35, 1.0, 0.9)}, kLimits);
  EXPECT_EQ(choice.chosen_w, 35.0);
  EXPECT_THAT(choice.powers[0].reasons, ElementsAre("a: the ring stays open"));
}

TEST(ChoosePower, ASpecimenThatWasNotCutSpeaksAgainstEveryPower) {
  PowerCut none;
  none.specimen = "a";
  none.power_w = 35.0;
  none.speed_mm_s = 7.0;
  none.problem = "the specimen could not be stretched";
  const PowerChoice choice = choose_power(std::vector<PowerCut>{none, closed("b", 35, 0.8, 0.9)}, kLimits);
  EXPECT_FALSE(choice.chosen_w);
  EXPECT_THAT(choice.powers[0].reasons, ElementsAre("a: the specimen could not be stretched"));
  EXPECT_EQ(choice.powers[0].greatest_bulge_mm, 0.8);
}

TEST(ChoosePower, IsTheLowestThatFitsThoughAHigherOneBulges) {
  EXPECT_EQ(chosen_of({closed("a", 25, 1.5, 0.6), closed("a", 30, 1.1, 0.8), closed("a", 35, 1.3, 0.9),
                       closed("a", 40, 0.9, 0.95)}),
            30.0);
}

TEST(ChoosePower, AValueAtItsLimitFits) {
  EXPECT_EQ(chosen_of({closed("a", 30, 1.2, 1.0), closed("a", 35, 1.2, 1.0)}), 30.0);
}

TEST(ChoosePower, NoPowerFitsWhereTheFlatOnesBurn) {
  const PowerChoice choice =
      choose_power(std::vector<PowerCut>{closed("a", 30, 1.3, 0.8), closed("a", 40, 1.5, 1.1)}, kLimits);
  EXPECT_FALSE(choice.chosen_w);
  EXPECT_EQ(choice.powers[1].reasons.size(), 2U);
}

TEST(ChoosePower, RefusesNumbersThatAreNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -0.1}) {
    EXPECT_THROW((void)chosen_of({closed("a", 35, bad, 0.9)}), InvalidArgument);
    EXPECT_THROW((void)chosen_of({closed("a", 35, 0.9, bad)}), InvalidArgument);
    EXPECT_THROW((void)chosen_of({closed("a", bad, 0.9, 0.9)}), InvalidArgument);
    EXPECT_THROW((void)choose_power(papers_series(), {.bulge_limit_mm = bad}), InvalidArgument);
  }
  PowerCut unmeasured = closed("a", 35, 1.0, 0.9);
  unmeasured.bulge_mm.reset();
  EXPECT_THROW((void)chosen_of({unmeasured}), InvalidArgument);
}

TEST(ChoosePower, RefusesSpecimensThatAreNotCutAtEveryPowerOnceAtOneSpeed) {
  EXPECT_THROW((void)chosen_of({}), InvalidArgument);
  EXPECT_THROW((void)chosen_of({closed("a", 30, 1.0, 0.9), closed("b", 35, 1.0, 0.9)}), InvalidArgument);
  EXPECT_THROW((void)chosen_of({closed("a", 30, 1.0, 0.9), closed("a", 30, 1.0, 0.9)}), InvalidArgument);
  PowerCut slow = closed("b", 30, 1.0, 0.9);
  slow.speed_mm_s = 3.0;
  EXPECT_THROW((void)chosen_of({closed("a", 30, 1.0, 0.9), slow}), InvalidArgument);
}

}  // namespace
}  // namespace incise
