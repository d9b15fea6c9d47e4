#include "planning/bodies.hpp"
#include "planning/fake_tissue.hpp"
#include "support/contour_shapes.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/random.hpp>
#include <incise/planning/robust_compensation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using testing::FakeTissue;
using ::testing::HasSubstr;
using testing::kChordMm;
using testing::kRingRadiusMm;
using testing::kTurn;

/// A residual that is stationary along the ring.
struct ResidualShape {
  double sd_mm = 0.3;         ///< at a place …
  double length_mm = 6.0;     ///< … and over which its correlation falls to 1/e
  double common_mm = 0.0;     ///< the same all round
  double placement_mm = 0.0;  ///< of a shift, along each axis
  double mean_mm = 0.0;
  std::size_t degrees = 0;
};

CutResidual residual_of(const ResidualShape& shape) {
  CutResidual residual{std::vector<double>(48, shape.mean_mm), Eigen::MatrixXd(48, 48), shape.degrees};
  for (int i = 0; i < 48; ++i) {
    for (int j = 0; j < 48; ++j) {
      const double turn = kTurn * std::min(std::abs(i - j), 48 - std::abs(i - j)) / 48.0;
      residual.covariance_mm2(i, j) = std::pow(shape.sd_mm, 2) * std::exp(-turn * kRingRadiusMm / shape.length_mm) +
                                      std::pow(shape.common_mm, 2) + std::pow(shape.placement_mm, 2) * std::cos(turn);
    }
  }
  return residual;
}

class Robust : public ::testing::Test {
 protected:
  struct Scenario {
    double weight, bias_mm;
    std::optional<FakeTissue> tissue;  ///< nothing: its cut cannot be measured
  };
  static Scenario scenario(double weight, double bias_mm, const FakeTissue& tissue) {
    return {weight, bias_mm, tissue};
  }
  static MeasureScenarios cuts_of(const std::vector<Scenario>& scenarios) {
    return [scenarios](const ToolPath& path) {
      std::vector<std::optional<PathErrors>> cuts;
      for (const Scenario& s : scenarios) cuts.push_back(s.tissue ? std::optional(s.tissue->cut(path)) : std::nullopt);
      return cuts;
    };
  }
  static std::vector<CutScenario> weighted(const std::vector<Scenario>& scenarios) {
    std::vector<CutScenario> list;
    for (const Scenario& s : scenarios) list.push_back({s.weight, s.bias_mm});
    return list;
  }
  RobustCompensation run(double corrected_mm, const std::vector<Scenario>& scenarios,
                         const ResidualShape& residual = {}, const RobustSettings& settings = {}) {
    return compensate_robust(path_, std::vector<double>(48, corrected_mm), surface_, weighted(scenarios),
                             cuts_of(scenarios), residual_of(residual), settings);
  }
  PathOutlook foresee(double corrected_mm, const std::vector<Scenario>& scenarios, const ResidualShape& residual,
                      const RobustSettings& settings = {}) {
    return foresee_paths(path_, std::vector<double>(48, corrected_mm), surface_, weighted(scenarios),
                         cuts_of(scenarios), residual_of(residual), settings);
  }
  SurfaceQuery surface_{testing::flat_body()};
  ToolPath path_ = plan_ring(surface_, testing::circle(testing::kEdgeRadiusMm, 1440), {.waypoints = 48});
  FakeTissue tissue_{.drift_mm = [](double) { return -1.0; }};
};

/// P(min over 48 places of e + r < least) for a residual that is a first-order autoregression round most of the ring,
/// counted from random numbers of its own.
double counted_probability(const std::vector<double>& errors, double least, const ResidualShape& s) {
  Random random(99);
  const double step = kTurn * kRingRadiusMm / 48.0;
  const double carried = std::exp(-step / s.length_mm);
  int close = 0;
  constexpr int kTrials = 20000;
  for (int trial = 0; trial < kTrials; ++trial) {
    bool is_close = false;
    double residual = s.sd_mm * random.normal();
    for (const double error : errors) {
      is_close = is_close || error + residual < least;
      residual = carried * residual + s.sd_mm * std::sqrt(1.0 - carried * carried) * random.normal();
    }
    close += is_close ? 1 : 0;
  }
  return static_cast<double>(close) / kTrials;
}

TEST_F(Robust, WithOneScenarioAndRoomEnoughItIsThePathOfLeastError) {
  const RobustCompensation result = run(0.6, {scenario(1.0, 0.0, tissue_)});
  EXPECT_EQ(result.outcome, RobustOutcome::Met);
  EXPECT_THAT(result.offset_mm, Each(::testing::DoubleNear(1.0, kChordMm)));
  // All that is left is the residual's own mean size.
  EXPECT_NEAR(result.robust.expected_abs_error_mm, 0.3 * std::sqrt(2.0 / std::numbers::pi), 0.005);
  EXPECT_GT(result.corrected.expected_abs_error_mm, result.robust.expected_abs_error_mm);
  EXPECT_GT(result.intended.expected_abs_error_mm, result.corrected.expected_abs_error_mm);
  EXPECT_EQ(result.simulations, 3U) << "intended, corrected, chosen";
}

TEST_F(Robust, ItLiesBetweenScenariosByTheirWeights) {
  // |error| is least where half of the weight lies on either side.
  const RobustCompensation result = run(
      1.0, {scenario(1.0, 0.6, tissue_), scenario(8.0, 0.0, tissue_), scenario(1.0, -0.6, tissue_)}, {.sd_mm = 0.05});
  EXPECT_THAT(result.offset_mm, Each(::testing::DoubleNear(1.0, 2.0 * kChordMm)));
  const RobustCompensation heavy =
      run(1.0, {scenario(9.0, -0.6, tissue_), scenario(1.0, 0.0, tissue_)}, {.sd_mm = 0.05});
  EXPECT_THAT(heavy.offset_mm, Each(::testing::DoubleNear(1.6, 2.0 * kChordMm)));
}

TEST_F(Robust, BuysTheProbabilityWithAsLittleErrorAsItCosts) {
  // A target of 3.2 mm leaves 0.5 mm above the close margin: with residuals of 0.3 mm most rings come too close
  // somewhere.
  const ResidualShape residual{.sd_mm = 0.3};
  const std::vector<Scenario> scenarios{scenario(1.0, 0.2, tissue_), scenario(1.0, -0.2, tissue_)};
  const RobustCompensation result = run(1.0, scenarios, residual, {.target_mm = 3.2});
  ASSERT_EQ(result.outcome, RobustOutcome::Met) << result.robust.p_close_margin;
  EXPECT_GT(result.intended.p_close_margin, 0.99);
  EXPECT_GT(result.corrected.p_close_margin, 0.4);
  EXPECT_LE(result.robust.p_close_margin, 0.05);
  EXPECT_GT(result.robust.p_close_margin, 0.02) << "no farther out than it has to be";
  EXPECT_GT(result.robust.expected_abs_error_mm, result.corrected.expected_abs_error_mm) << "safety is not free";

  // The same probability, counted here.
  double counted = 0.0;
  for (const double bias : {0.2, -0.2}) {
    std::vector<double> errors;
    for (const double offset : result.offset_mm) errors.push_back(offset - 1.0 + bias);
    counted += 0.5 * counted_probability(errors, 2.2 + 0.5 - 3.2, residual);
  }
  EXPECT_NEAR(counted, result.robust.p_close_margin, 0.012);
}

TEST_F(Robust, SaysWhereNoPathKeepsTheProbability) {
  RobustSettings settings{.target_mm = 3.2};
  settings.region.max_offset_mm = 1.1;
  const RobustCompensation result = run(1.0, {scenario(1.0, 0.0, tissue_)}, {}, settings);
  EXPECT_EQ(result.outcome, RobustOutcome::NotMet);
  EXPECT_GT(result.robust.p_close_margin, 0.05);
  EXPECT_LT(result.robust.p_close_margin, result.corrected.p_close_margin) << "the best that there is";
  EXPECT_THAT(result.offset_mm, Each(::testing::Le(1.1 + 1e-9)));
}

TEST_F(Robust, AimsLowerWhereTheCutsAreWorseThanForetold) {
  // This tissue answers to a move by half: what is foretold from the corrected path falls short.
  const FakeTissue stiff{.drift_mm = [](double) { return -1.0; }, .gain = 0.5};
  const RobustCompensation one = run(2.0, {scenario(1.0, 0.0, stiff)}, {}, {.target_mm = 3.2, .rounds = 1});
  const RobustCompensation three = run(2.0, {scenario(1.0, 0.0, stiff)}, {}, {.target_mm = 3.2, .rounds = 4});
  EXPECT_EQ(one.outcome, RobustOutcome::NotMet);
  EXPECT_EQ(three.outcome, RobustOutcome::Met) << three.robust.p_close_margin;
  EXPECT_GT(three.simulations, one.simulations);
}

TEST_F(Robust, LeavesOutAndCountsScenariosThatCannotBeMeasured) {
  const Scenario open{1.0, 0.0, std::nullopt};
  const RobustCompensation result = run(0.5, {scenario(3.0, 0.0, tissue_), open}, {});
  EXPECT_NEAR(result.robust.unmeasured_weight, 0.25, 1e-12);
  EXPECT_THAT(result.offset_mm, Each(::testing::DoubleNear(1.0, kChordMm)));
  EXPECT_EQ(run(0.5, {open}, {}).outcome, RobustOutcome::NoMeasure);
}

TEST_F(Robust, ARingThatStaysOpenIsNoWayToASmallProbability) {
  // With every tissue measured the path is safe; that a quarter of what is believed possible shows no ring is not.
  EXPECT_EQ(run(1.0, {scenario(3.0, 0.0, tissue_), scenario(1.0, 0.0, tissue_)}, {}).outcome, RobustOutcome::Met);
  const RobustCompensation open = run(1.0, {scenario(3.0, 0.0, tissue_), {1.0, 0.0, std::nullopt}}, {});
  EXPECT_EQ(open.outcome, RobustOutcome::NotMet);
  EXPECT_LT(open.robust.p_close_margin, 0.01);
  EXPECT_NEAR(open.robust.p_close_bound(), 0.25 + 0.75 * open.robust.p_close_margin, 1e-12);
}

TEST_F(Robust, AnErrorThatIsTheSameAllRoundCountsOnceAndNotAtEveryPlace) {
  // Of the whole cut 0.3 mm sd, of each place hardly any: too close with the probability of one normal number.
  const ResidualShape residual{.sd_mm = 0.005, .length_mm = 100.0, .common_mm = 0.3};
  const PathOutlook outlook = foresee(1.0, {scenario(1.0, 0.0, tissue_)}, residual, {.target_mm = 3.2});
  EXPECT_NEAR(outlook.corrected.p_close_margin, 0.5 * std::erfc(0.5 / 0.3 / std::sqrt(2.0)), 0.015);
  EXPECT_NEAR(outlook.corrected.expected_abs_error_mm, 0.3 * std::sqrt(2.0 / std::numbers::pi), 0.005);
}

TEST_F(Robust, AShiftOfTheWholeCutComesTooCloseOnOneSide) {
  // A shift by (u, v) of 0.3 mm sd each takes away its length at its far side: Rayleigh.
  const ResidualShape residual{.sd_mm = 0.005, .length_mm = 100.0, .placement_mm = 0.3};
  const PathOutlook outlook = foresee(1.0, {scenario(1.0, 0.0, tissue_)}, residual, {.target_mm = 3.4});
  // Straight lines between waypoints take away up to a chord's height of those 0.7 mm.
  const auto beyond = [](double way_mm) { return std::exp(-0.5 * std::pow(way_mm / 0.3, 2)); };
  EXPECT_GT(outlook.corrected.p_close_margin, beyond(0.7) - 0.01);
  EXPECT_LT(outlook.corrected.p_close_margin, beyond(0.7 - kChordMm) + 0.01);
}

TEST_F(Robust, ForeseesWhatTheCorrectionWinsAndHowSurely) {
  // Errors of -1 mm all round and none: with a residual that is small beside them the gain is 1 mm.
  const ResidualShape calm{.sd_mm = 0.005};
  const PathOutlook sure = foresee(1.0, {scenario(1.0, 0.0, tissue_)}, calm);
  ASSERT_TRUE(sure.gain);
  EXPECT_NEAR(sure.gain->mean_mm, 1.0, kChordMm);
  EXPECT_LT(sure.gain->sd_mm, 0.01);
  EXPECT_EQ(sure.gain->p_worse, 0.0);

  // In three of four scenarios the gain is 1 mm, in the fourth the cut as planned was right and the correction is not.
  const PathOutlook split = foresee(1.0, {scenario(3.0, 0.0, tissue_), scenario(1.0, 1.0, tissue_)}, calm);
  ASSERT_TRUE(split.gain);
  EXPECT_NEAR(split.gain->mean_mm, 0.75 * 1.0 - 0.25 * 1.0, kChordMm);
  EXPECT_NEAR(split.gain->sd_mm, 2.0 * std::sqrt(0.75 * 0.25), 2.0 * kChordMm);
  EXPECT_NEAR(split.gain->p_worse, 0.25, 1e-12);
  EXPECT_NEAR(split.gain->move_mm, 1.0, kChordMm);

  // Nothing is compared where one of the two cuts shows no ring.
  EXPECT_FALSE(foresee(1.0, {{1.0, 0.0, std::nullopt}}, calm).gain);
}

TEST_F(Robust, AResidualThatBothCutsShareTakesGainAwayOnlyWhereItTurnsTheSign) {
  // |-1 + r| - |0 + r| with one r for the whole ring: E|r - 1| - E|r|.
  const ResidualShape loud{.sd_mm = 0.005, .common_mm = 0.6};
  const PathOutlook outlook = foresee(1.0, {scenario(1.0, 0.0, tissue_)}, loud);
  const double z = 1.0 / 0.6;
  const double folded = 0.6 * std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * z * z) + std::erf(z / std::sqrt(2.0));
  EXPECT_NEAR(outlook.gain->mean_mm, folded - 0.6 * std::sqrt(2.0 / std::numbers::pi), 0.03);
  EXPECT_NEAR(outlook.gain->p_worse, 0.5 * std::erfc(0.5 / 0.6 / std::sqrt(2.0)), 0.03) << "r beyond the middle";
}

TEST_F(Robust, WhatIsExpectedBeyondTheScenarioMovesThePath) {
  // Real cuts lie 0.4 mm farther out than this tissue says: so much less is corrected.
  const RobustCompensation result = run(1.0, {scenario(1.0, 0.0, tissue_)}, {.sd_mm = 0.05, .mean_mm = 0.4});
  EXPECT_THAT(result.offset_mm, Each(::testing::DoubleNear(0.6, 2.0 * kChordMm)));
}

TEST_F(Robust, ItsIntervalsAreThoseOfTheMeanErrorOfOneCut) {
  // |r| of one normal number all round the ring: quantiles 0.1 and 0.9 of the half-normal distribution.
  const PathOutlook normal = foresee(1.0, {scenario(1.0, 0.0, tissue_)}, {.sd_mm = 0.005, .common_mm = 0.3});
  ASSERT_TRUE(normal.corrected.abs_error_80 && normal.corrected.abs_error_95);
  EXPECT_NEAR(normal.corrected.abs_error_80->low, 0.3 * 0.1257, 0.01);
  EXPECT_NEAR(normal.corrected.abs_error_80->high, 0.3 * 1.6449, 0.02);
  EXPECT_NEAR(normal.corrected.abs_error_95->high, 0.3 * 2.2414, 0.03);
  ASSERT_TRUE(normal.gain && normal.gain->interval_80);
  EXPECT_NEAR(normal.gain->interval_80->high, 1.0, kChordMm) << "what a right cut gains over one that errs by 1 mm";
  EXPECT_LT(normal.gain->interval_80->low, normal.gain->mean_mm);
}

TEST_F(Robust, SpreadsThatAreEstimatedHaveStudentsTails) {
  // Student's t of 4 degrees: |t| is below 2.132 with 90 %, and below 3.495 with 97.5 %.
  const ResidualShape few{.sd_mm = 0.005, .common_mm = 0.3, .degrees = 4};
  const PathOutlook outlook = foresee(1.0, {scenario(1.0, 0.0, tissue_)}, few, {.target_mm = 3.2});
  EXPECT_NEAR(outlook.corrected.abs_error_80->high, 0.3 * 2.132, 0.05);
  EXPECT_NEAR(outlook.corrected.abs_error_95->high, 0.3 * 3.495, 0.12);
  // Below -0.5 mm: P(t < -1.667) = 0.085, or 0.096 with a chord's height less; normal they would be 0.048 and 0.059.
  EXPECT_GT(outlook.corrected.p_close_margin, 0.085 - 0.01);
  EXPECT_LT(outlook.corrected.p_close_margin, 0.096 + 0.015);
}

TEST_F(Robust, IsTheSameForTheSameSeed) {
  const std::vector<Scenario> scenarios{scenario(1.0, 0.1, tissue_), scenario(2.0, -0.3, tissue_)};
  const RobustCompensation a = run(0.8, scenarios, {}, {.target_mm = 3.4});
  const RobustCompensation b = run(0.8, scenarios, {}, {.target_mm = 3.4});
  EXPECT_EQ(a.offset_mm, b.offset_mm);
  EXPECT_EQ(a.robust.p_close_margin, b.robust.p_close_margin);
}

TEST_F(Robust, TellsEveryViolation) {
  const RobustSettings bad{.max_probability = 1.0, .rounds = 0, .samples = 10};
  EXPECT_THAT(sentences(problems_of(bad)),
              ElementsAre(HasSubstr("max_probability"), HasSubstr("rounds"), HasSubstr("samples")));
  const std::vector<Scenario> one{scenario(1.0, 0.0, tissue_)};
  EXPECT_THROW(static_cast<void>(run(0.0, one, {}, bad)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run(0.0, {})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run(0.0, {scenario(0.0, 0.0, tissue_)})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run(0.0, one, {.sd_mm = 0.0})), InvalidArgument) << "nothing is known exactly";
  EXPECT_THROW(static_cast<void>(run(0.0, one, {.mean_mm = std::nan("")})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run(0.0, one, {.degrees = 2})), InvalidArgument) << "no variance";
  const CutResidual residual = residual_of({});
  EXPECT_THROW(static_cast<void>(compensate_robust(path_, {0.0}, surface_, weighted(one), cuts_of(one), residual)),
               InvalidArgument);
  CutResidual shorter = residual;
  shorter.mean_mm.pop_back();
  const std::vector<double> still(48, 0.0);
  EXPECT_THROW(static_cast<void>(compensate_robust(path_, still, surface_, weighted(one), cuts_of(one), shorter)),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(compensate_robust(
                   path_, still, surface_, weighted(one),
                   [](const ToolPath&) { return std::vector<std::optional<PathErrors>>{}; }, residual)),
               InvalidArgument);
}

}  // namespace
}  // namespace incise
