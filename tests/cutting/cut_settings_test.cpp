#include <incise/cutting/cut_settings.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNeedleDiameterMm = 1.0;

TEST(CutSettings, DefaultsAreThePapersPairAndValid) {
  const CutSettings settings;
  EXPECT_DOUBLE_EQ(settings.speed_mm_s, 13.0);
  EXPECT_DOUBLE_EQ(settings.dullness, 9.0);
  EXPECT_NEAR(settings.dwell_s(), 0.18, 1e-12);
  EXPECT_NEAR(settings.step_s(), 0.02, 1e-12);
  EXPECT_THAT(validate(settings, kNeedleDiameterMm), IsEmpty());
}

TEST(CutSettings, EveryViolationIsListedWithItsField) {
  CutSettings settings;
  settings.speed_mm_s = 0.0;
  settings.dullness = -1.0;
  settings.bond_stiffness_kpa_mm2 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
              ElementsAre(HasSubstr("speed_mm_s: found 0"), HasSubstr("dullness: found -1"),
                          HasSubstr("bond_stiffness_kpa_mm2: found nan")));
}

TEST(CutSettings, AStepLongerThanTheNeedleIsWideIsRefused) {
  CutSettings settings{.advance_per_step_mm = 1.01};
  EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
              ElementsAre(HasSubstr("advance_per_step_mm: found 1.01")));
}

TEST(CutSettings, APowerThatTakesForEverIsRefused) {
  CutSettings settings{.power_exponent = 3.0};
  for (const double power_w : {1e-3, 1e-200}) {
    settings.power_w = power_w;
    EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
                ElementsAre(HasSubstr("s of contact until tissue is cut, expected at most 600 s")))
        << power_w;
  }
}

TEST(CutSettings, StepsSolvedSoLooselyOrTightlyThatNoCutIsToBeBelievedAreRefused) {
  CutSettings settings;
  for (const double good : {1e-6, 1e-4, 0.3}) {
    settings.residual_tolerance = good;
    EXPECT_THAT(validate(settings, kNeedleDiameterMm), IsEmpty()) << good;
  }
  for (const double bad : {1e-300, 9e-7, 0.31, 0.99}) {
    settings.residual_tolerance = bad;
    EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
                ElementsAre(HasSubstr("expected a number in [1e-06, 0.3]")))
        << bad;
  }
}

TEST(CutSettings, AStepThatNoCutEndsWithIsRefused) {
  CutSettings settings{.advance_per_step_mm = 1e-9};
  EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
              ElementsAre(HasSubstr("advance_per_step_mm: found 1e-09")));
}

TEST(CutSettings, APowerOfTheLawOutOfRangeIsRefused) {
  CutSettings settings;
  settings.power_w = 0.0;
  settings.power_exponent = 10.5;
  settings.tear_energy_kpa = 0.0;
  settings.slip_mm = std::numeric_limits<double>::infinity();
  EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
              ElementsAre(HasSubstr("power_w: found 0"), HasSubstr("power_exponent: found 10.5"),
                          HasSubstr("tear_energy_kpa: found 0"), HasSubstr("slip_mm: found inf")));
}

TEST(CutSettings, ByThePapersRuleStepsTakeTheReferenceTimeAtAnySpeed) {
  CutSettings settings{.advance_per_step_mm = 0.1};
  for (const double speed_mm_s : {1.0, 17.0}) {
    settings.speed_mm_s = speed_mm_s;
    settings.rule = CutRule::Paper;
    EXPECT_DOUBLE_EQ(settings.step_s(), settings.reference_step_s);
    EXPECT_DOUBLE_EQ(settings.advance_mm(), speed_mm_s * settings.reference_step_s);
    EXPECT_THAT(validate(settings, kNeedleDiameterMm), IsEmpty());
    settings.rule = CutRule::Tets;
    EXPECT_DOUBLE_EQ(settings.step_s(), 0.1 / speed_mm_s);
    EXPECT_DOUBLE_EQ(settings.advance_mm(), 0.1);
  }
}

TEST(CutSettings, ThePapersRuleRefusesTearingAndStepsLongerThanTheNeedleIsWide) {
  CutSettings settings{.speed_mm_s = 51.0, .tear_energy_kpa = 5.0, .rule = CutRule::Paper};
  EXPECT_THAT(sentences(validate(settings, kNeedleDiameterMm)),
              ElementsAre(HasSubstr("tear_energy_kpa: found 5, expected none"),
                          HasSubstr("reference_step_s: found 0.02 at 51 mm/s: 1.02 mm a step")));
}

TEST(CutSettings, TwiceThePowerCutsTwiceAsFastOrAsTheExponentSays) {
  CutSettings settings;
  EXPECT_NEAR(settings.dwell_rate_per_s(), 1.0 / 0.18, 1e-12);
  settings.power_w = 70.0;
  EXPECT_NEAR(settings.dwell_rate_per_s(), 2.0 / 0.18, 1e-12);
  settings.power_exponent = 0.0;
  EXPECT_NEAR(settings.dwell_rate_per_s(), 1.0 / 0.18, 1e-12);
}

TEST(CutSettings, WhatCutsIsTheEnergyOnAnAreaOfTheCut) {
  CutSettings settings;
  EXPECT_EQ(settings.relative_energy(), 1.0);
  settings.real_speed_mm_s = 14.0;
  settings.depth_mm = 2.5;
  EXPECT_EQ(settings.relative_energy(), 1.0) << "twice as fast, half as deep";
  settings.depth_mm = 5.0;
  EXPECT_EQ(settings.relative_energy(), 0.5);
  EXPECT_NEAR(settings.dwell_rate_per_s(), 0.5 / 0.18, 1e-12);
  settings.power_w = 70.0;
  EXPECT_EQ(settings.relative_energy(), 1.0) << "that much more power makes up for it";
  settings.reference_real_speed_mm_s = 14.0;
  EXPECT_EQ(settings.relative_energy(), 2.0);
}

}  // namespace
}  // namespace incise
