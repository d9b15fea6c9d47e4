#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/planning/eligibility.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A specimen like those of the calibration, whose correction wins a millimetre.
EligibilityEvidence good() {
  EligibilityEvidence evidence;
  evidence.intended = {.expected_abs_error_mm = 1.6, .p_close_margin = 0.30, .unmeasured_weight = 0.0};
  evidence.corrected = {.expected_abs_error_mm = 0.6, .p_close_margin = 0.01, .unmeasured_weight = 0.0};
  evidence.gain = CutGain{.mean_mm = 1.0, .sd_mm = 0.4, .p_worse = 0.01};
  evidence.registration_rmse_mm = 0.4;
  evidence.distances = {{"youngs_modulus_kpa", 13.0, 12.0, 0.3}};
  return evidence;
}

TEST(JudgeEligibility, CompensatesWhereTheGainIsAboveItsUncertainty) {
  const Eligibility judged = judge_eligibility(good());
  EXPECT_EQ(judged.advice, Advice::Compensate);
  EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("1.00 ± 0.40 mm")));
}

TEST(JudgeEligibility, TellsInWhichShareOfTissuesTheCorrectedRingStaysOpen) {
  EligibilityEvidence evidence = good();
  evidence.intended = {.expected_abs_error_mm = 1.6, .p_close_margin = 0.95, .unmeasured_weight = 0.0};
  evidence.corrected.unmeasured_weight = 0.4;
  EXPECT_THAT(judge_eligibility(evidence).reasons, ElementsAre(HasSubstr("stays open in 40 % of")));
  evidence.gain->p_worse = 0.2;
  EXPECT_THAT(judge_eligibility(evidence).reasons,
              ElementsAre(::testing::AllOf(HasSubstr("above 0.15"), HasSubstr("stays open in 40 % of"))));
}

TEST(JudgeEligibility, CutsAsPlannedWhereTheGainIsNotAboveItsUncertainty) {
  EligibilityEvidence evidence = good();
  evidence.gain->mean_mm = 0.4;  // just its sd: not above
  Eligibility judged = judge_eligibility(evidence);
  EXPECT_EQ(judged.advice, Advice::CutAsPlanned);
  EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("expected gain of 0.40 mm")));
  evidence.gain->mean_mm = 0.401;
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::Compensate);
  evidence.gain = CutGain{.mean_mm = -0.5, .sd_mm = 0.1, .p_worse = 0.99};
  judged = judge_eligibility(evidence);
  EXPECT_EQ(judged.advice, Advice::CutAsPlanned);
  EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("-0.50 mm"), HasSubstr("probability of 0.99")));
}

TEST(JudgeEligibility, CutsAsPlannedWhereTheCorrectionIsNotAccepted) {
  EligibilityEvidence evidence = good();
  evidence.is_accepted = false;
  const Eligibility judged = judge_eligibility(evidence);
  EXPECT_EQ(judged.advice, Advice::CutAsPlanned);
  EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("not accepted")));
}

TEST(JudgeEligibility, AGainWithoutAnyUncertaintyHasToBeAGain) {
  EligibilityEvidence evidence = good();
  evidence.gain = CutGain{.mean_mm = 0.0, .sd_mm = 0.0, .p_worse = 0.0};
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::CutAsPlanned) << "nothing to win";
  evidence.gain = CutGain{.mean_mm = 0.01, .sd_mm = 0.0, .p_worse = 0.0};
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::Compensate);
}

TEST(JudgeEligibility, CutsAsPlannedWhereTheCorrectionCostsMargin) {
  EligibilityEvidence evidence = good();
  evidence.corrected.p_close_margin = 0.2;
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::Compensate) << "much, but less than as planned";
  evidence.intended.p_close_margin = 0.1;
  const Eligibility judged = judge_eligibility(evidence);
  EXPECT_EQ(judged.advice, Advice::CutAsPlanned);
  EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("probability of 0.200")));
}

TEST(JudgeEligibility, DoesNotUseWhatLiesOutsideTheCalibratedRange) {
  for (const double in_sd : {3.1, -3.1}) {
    EligibilityEvidence evidence = good();
    evidence.distances.push_back({"compliance_mm_n", 1.0, 5.0, in_sd});
    const Eligibility judged = judge_eligibility(evidence);
    EXPECT_EQ(judged.advice, Advice::DoNotUse);
    EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("compliance_mm_n: 1 is 3.1 standard deviations")));
    evidence.distances.back().in_sd = 2.9;
    EXPECT_EQ(judge_eligibility(evidence).advice, Advice::Compensate);
  }
}

TEST(JudgeEligibility, ABetterRegistrationThanTheCalibrationsIsNoObjection) {
  EligibilityEvidence evidence = good();
  evidence.distances = {{"registration_rmse_mm", 0.05, 0.4, -6.0, true}};
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::Compensate);
  evidence.distances = {{"registration_rmse_mm", 0.9, 0.2, 6.0, true}};
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::DoNotUse);
}

TEST(JudgeEligibility, DoesNotUseABadRegistrationAndSaysAllThatSpeaksAgainstIt) {
  EligibilityEvidence evidence = good();
  evidence.registration_rmse_mm = 1.2;
  EXPECT_THAT(judge_eligibility(evidence).reasons, ElementsAre(HasSubstr("1.20 mm (rms)")));
  evidence.is_registered = false;
  evidence.corrected.unmeasured_weight = 0.6;
  const Eligibility judged = judge_eligibility(evidence);
  EXPECT_EQ(judged.advice, Advice::DoNotUse);
  EXPECT_THAT(judged.reasons,
              ElementsAre(HasSubstr("registration was refused"), HasSubstr("1.20 mm"), HasSubstr("60 %")));
}

TEST(JudgeEligibility, DoesNotUseWhatCannotBeForetold) {
  EligibilityEvidence evidence = good();
  evidence.gain.reset();
  evidence.no_gain_because = "open_loop";
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::DoNotUse);
  EXPECT_THAT(judge_eligibility(evidence).reasons, ElementsAre(HasSubstr("open_loop")));
  evidence = good();
  evidence.registration_rmse_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::DoNotUse);
  evidence = good();
  evidence.gain->mean_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::DoNotUse);
}

TEST(ProbabilityUnlike, FollowsBayesRuleAtTheFarthestDistance) {
  const auto at = [](double in_sd, double degrees) {
    const std::vector<SpecimenDistance> distances = {{"scale", 1.0, 1.0, 0.5, false, degrees},
                                                     {"modulus", 1.0, 1.0, in_sd, false, degrees}};
    return probability_unlike(distances);
  };
  // By hand, five degrees of freedom, at 3: density of t 0.0172926, of ten times t 0.0359825; 0.05 / 0.95 of their
  // ratio.
  EXPECT_NEAR(at(3.0, 5.0), 0.05 * 0.0359825 / (0.05 * 0.0359825 + 0.95 * 0.0172926), 1e-5);
  const std::vector<std::pair<double, double>> told = {
      {0.6, 0.0065}, {2.0, 0.0341}, {3.0, 0.2090}, {4.0, 0.7324}, {5.0, 0.9693}};
  for (const auto& [in_sd, expected] : told) EXPECT_NEAR(at(in_sd, 23.0), expected, 5e-4) << in_sd;
  EXPECT_EQ(at(-3.0, 23.0), at(3.0, 23.0)) << "too soft is as unlike as too stiff";
  EXPECT_EQ(at(0.1, 23.0), at(-0.5, 23.0)) << "the farthest of the two counts";
  EXPECT_LT(at(4.0, 5.0), 0.5 * at(4.0, 23.0)) << "two specimens hardly tell how widely they are spread";
  for (const double degrees : {4.0, 23.0, 500.0}) {
    for (double in_sd = 0.5; in_sd < 40.0; in_sd *= 1.5) {
      EXPECT_LE(at(in_sd, degrees), at(1.5 * in_sd, degrees)) << "farther is never more alike: " << in_sd;
    }
    EXPECT_GT(at(100.0, degrees), 0.99);
  }
  EXPECT_EQ(at(std::numeric_limits<double>::quiet_NaN(), 5.0), 1.0);
  EXPECT_EQ(probability_unlike({}), kPriorUnlike);
}

TEST(ProbabilityUnlike, DoesNotCountWhatIsBetterBelow) {
  const std::vector<SpecimenDistance> better = {{"rmse", 0.1, 0.4, -8.0, true, 23.0}};
  const std::vector<SpecimenDistance> worse = {{"rmse", 3.0, 0.4, 8.0, true, 23.0}};
  EXPECT_LT(probability_unlike(better), 0.01);
  EXPECT_GT(probability_unlike(worse), 0.99);
}

TEST(ProbabilityWorseIfUnlike, IsThatOfACutThatErrsLessThanHalfTheMove) {
  const std::vector<double> errors = {-1.5, -1.9};  // -1.7 in the mean, give or take 0.7
  EXPECT_NEAR(probability_worse_if_unlike(2.0, errors), 0.5 * std::erfc(1.0 / std::sqrt(2.0)), 1e-12) << "e > -1.0";
  EXPECT_NEAR(probability_worse_if_unlike(3.4, errors), 0.5, 1e-12) << "twice as far as they err";
  EXPECT_LT(probability_worse_if_unlike(1.1, errors), probability_worse_if_unlike(1.9, errors)) << "farther is riskier";
  EXPECT_NEAR(probability_worse_if_unlike(-0.6, errors), 0.5 * std::erfc(-2.0 / 0.7 / std::sqrt(2.0)), 1e-12)
      << "the wrong way is nearly always worse: e < 0.3";
  EXPECT_EQ(probability_worse_if_unlike(-2.0, std::vector<double>{1.7}), probability_worse_if_unlike(2.0, errors))
      << "the mirror image";
  EXPECT_EQ(probability_worse_if_unlike(2.0, {}), 0.5) << "no calibrated cut to go by";
}

TEST(JudgeEligibility, BelievesWhatIsSaidOfTheUnlikeAsFarAsASpecimenIs) {
  EligibilityEvidence evidence = good();
  evidence.calibrated_error_mm = {-1.7};
  evidence.gain->move_mm = 2.0;
  evidence.distances.front() = {"youngs_modulus_kpa", 3.0, 12.0, -4.0, false, 23.0};
  const Eligibility judged = judge_eligibility(evidence);
  EXPECT_EQ(*judged.p_worse_if_unlike, probability_worse_if_unlike(2.0, evidence.calibrated_error_mm));
  EXPECT_NEAR(*judged.p_worse, (1.0 - judged.p_unlike) * 0.01 + judged.p_unlike * *judged.p_worse_if_unlike, 1e-15);
}

TEST(JudgeEligibility, SaysOneHalfOfWhatTheCalibrationSaysNothingOf) {
  EligibilityEvidence evidence = good();
  evidence.gain->p_worse = 0.02;
  const Eligibility near = judge_eligibility(evidence);
  EXPECT_NEAR(*near.p_worse, 0.02 * (1.0 - near.p_unlike) + 0.5 * near.p_unlike, 1e-15);
  EXPECT_LT(*near.p_worse, 0.025);
  evidence.distances.front().in_sd = -1e3;
  EXPECT_NEAR(*judge_eligibility(evidence).p_worse, 0.5, 2e-3) << "a sure gain of a simulation that is not believed";
  evidence.gain->p_worse = 0.98;
  EXPECT_NEAR(*judge_eligibility(evidence).p_worse, 0.5, 2e-3) << "nor is a sure loss";
  evidence.gain->sd_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(judge_eligibility(evidence).p_worse) << "no number";
  evidence.gain.reset();
  EXPECT_FALSE(judge_eligibility(evidence).p_worse);
}

TEST(JudgeEligibility, SaysOneHalfWhereSomethingElseThanADistanceSpeaksAgainstTheSimulation) {
  EligibilityEvidence evidence = good();
  evidence.calibrated_error_mm = {-1.7};
  evidence.gain->move_mm = 1.6;
  ASSERT_LT(*judge_eligibility(evidence).p_worse, 0.1);
  evidence.is_registered = false;
  EXPECT_EQ(judge_eligibility(evidence).p_unlike, 1.0);
  EXPECT_EQ(*judge_eligibility(evidence).p_worse, 0.5);
  evidence = good();
  evidence.corrected.unmeasured_weight = 0.6;
  EXPECT_EQ(judge_eligibility(evidence).p_unlike, 1.0);
}

TEST(JudgeEligibility, ADistanceNeverLiftsADoubt) {
  EligibilityEvidence evidence = good();
  evidence.gain->p_worse = 0.16;
  evidence.gain->move_mm = 0.2;
  evidence.calibrated_error_mm = {-1.7};  // so small a move would hardly ever be too much
  evidence.distances.front() = {"youngs_modulus_kpa", 30.0, 12.0, 2.9, false, 100.0};
  const Eligibility judged = judge_eligibility(evidence);
  ASSERT_LT(*judged.p_worse, 0.15);
  EXPECT_EQ(judged.advice, Advice::CutAsPlanned);
}

TEST(JudgeEligibility, IsNotSurerWithoutAPullThanBeforeAnythingWasMeasured) {
  EligibilityEvidence evidence = good();
  EXPECT_LT(judge_eligibility(evidence).p_unlike, 0.01);
  evidence.is_stiffness_compared = false;
  EXPECT_EQ(judge_eligibility(evidence).p_unlike, kPriorUnlike);
}

TEST(JudgeEligibility, CutsAsPlannedWhereASpecimenMayBeUnlike) {
  EligibilityEvidence evidence = good();
  evidence.distances.front() = {"youngs_modulus_kpa", 30.0, 12.0, 2.9, false, 100.0};  // believed, just so
  evidence.gain->p_worse = 0.08;
  const Eligibility judged = judge_eligibility(evidence);
  EXPECT_EQ(judged.advice, Advice::CutAsPlanned);
  EXPECT_THAT(judged.reasons, ElementsAre(HasSubstr("is the worse one with a probability of 0.1")));
  evidence.distances.front().in_sd = 0.0;
  EXPECT_EQ(judge_eligibility(evidence).advice, Advice::Compensate);
}

TEST(JudgeEligibility, RefusesRulesThatAreNone) {
  EXPECT_TRUE(problems_of(EligibilityRules{}).empty());
  const EligibilityRules bad{.least_gain_sds = -1.0, .most_rmse_mm = 0.0, .most_p_close_margin = 1.0};
  EXPECT_THAT(sentences(problems_of(bad)),
              ElementsAre(HasSubstr("least_gain_sds"), HasSubstr("most_rmse_mm"), HasSubstr("most_p_close_margin")));
  EXPECT_THROW(static_cast<void>(judge_eligibility(good(), bad)), InvalidArgument);
}

TEST(DistanceFrom, CountsInStandardDeviationsOfWhatANextSpecimenWouldShow) {
  // Two specimens: Σ (x - mean)² = 2; (4 · 9 + 2) / 5 · 1.5 = 11.4.
  const std::vector<double> two{9.0, 11.0};
  const SpecimenDistance far = distance_from("scale", 20.0, two, {.sd = 3.0});
  EXPECT_DOUBLE_EQ(far.mean, 10.0);
  EXPECT_DOUBLE_EQ(far.in_sd, 10.0 / std::sqrt(11.4));
  EXPECT_LT(distance_from("scale", 5.0, two, {.sd = 3.0}).in_sd, 0.0);
  // Many: their own spread alone.
  std::vector<double> many;
  for (int i = 0; i < 2000; ++i) many.push_back(i % 2 == 0 ? 9.0 : 11.0);
  EXPECT_NEAR(distance_from("scale", 12.0, many, {.sd = 3.0}).in_sd, 2.0, 0.03);
  // One tells no spread at all: the usual one, doubled in variance, as its own place is as uncertain.
  EXPECT_DOUBLE_EQ(distance_from("scale", 10.0 + 3.0 * std::sqrt(2.0), std::vector<double>{10.0}, {.sd = 3.0}).in_sd,
                   1.0);
}

TEST(DistanceFrom, OfLogarithmsIsAFactor) {
  const std::vector<double> moduli{6.0, 24.0};
  const SpecimenDistance twice = distance_from("kpa", 24.0, moduli, {.sd = 0.3, .is_logarithmic = true});
  const SpecimenDistance half = distance_from("kpa", 6.0, moduli, {.sd = 0.3, .is_logarithmic = true});
  EXPECT_NEAR(twice.mean, 12.0, 1e-12);
  EXPECT_NEAR(twice.in_sd, -half.in_sd, 1e-12);
  EXPECT_THROW(static_cast<void>(distance_from("kpa", 0.0, moduli, {.sd = 0.3, .is_logarithmic = true})),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(distance_from("kpa", 1.0, {}, {.sd = 0.3})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(distance_from("kpa", 1.0, moduli, {.sd = 0.0})), InvalidArgument);
}

}  // namespace
}  // namespace incise
