#include "planning/bodies.hpp"
#include "planning/fake_tissue.hpp"
#include "support/contour_shapes.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/planning/converging_compensation.hpp>

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
using testing::kEdgeRadiusMm;
using testing::kRingRadiusMm;
using testing::kTurn;
using ::testing::SizeIs;

class Converge : public ::testing::Test {
 protected:
  ConvergedCompensation run(const FakeTissue& tissue, const ConvergenceSettings& settings = {}) {
    return compensate_converging(
        path_, surface_, [&](const ToolPath& path) { return tissue.cut(path); }, settings);
  }
  SurfaceQuery surface_{testing::flat_body()};
  ToolPath path_ = plan_ring(surface_, testing::circle(kEdgeRadiusMm, 1440), {.waypoints = 48});
};

TEST_F(Converge, LeavesAPathWithoutErrorAsItIsAfterOneCut) {
  const ConvergedCompensation result = run({.drift_mm = [](double) { return 0.0; }});
  EXPECT_EQ(result.outcome, CompensationOutcome::Converged);
  EXPECT_THAT(result.passes, SizeIs(1));
  EXPECT_THAT(result.result().offset_mm, Each(0.0));
  EXPECT_FALSE(result.contraction);
  EXPECT_EQ(result.path.waypoints[7].position_mm, path_.waypoints[7].position_mm);
}

TEST_F(Converge, UndoesASmoothDriftWithTwoCuts) {
  const auto drift = [](double a) { return -1.4 + 0.8 * std::sin(2.0 * a); };
  const ConvergedCompensation result = run({.drift_mm = drift});
  EXPECT_EQ(result.outcome, CompensationOutcome::Converged);
  EXPECT_THAT(result.passes, SizeIs(2));
  EXPECT_NEAR(*result.passes[0].mean_abs_error_mm, 1.4, kChordMm);
  EXPECT_LT(*result.result().mean_abs_error_mm, 0.05);
  EXPECT_NEAR(*result.contraction, *result.passes[1].mean_abs_error_mm / *result.passes[0].mean_abs_error_mm, 1e-12);
  for (std::size_t i = 0; i < 48; ++i) {
    const Vec3& p = result.path.waypoints[i].position_mm;
    EXPECT_NEAR(p.head<2>().norm() - kRingRadiusMm, -drift(std::atan2(p.y(), p.x())), 2.0 * kChordMm)
        << "waypoint " << i;
  }
}

TEST_F(Converge, UndoesABlurThatPlainStepsOnlyCreepUpOn) {
  const FakeTissue tissue{.drift_mm = [](double a) { return -1.5 + 0.9 * std::cos(2.0 * a) + 0.5 * std::sin(4.0 * a); },
                          .lag_mm = 4.5};
  const ConvergedCompensation modelled = run(tissue, {.tolerance_mm = 1e-6, .shift_lags = 0.0});
  const ConvergedCompensation plain =
      run(tissue, {.tolerance_mm = 1e-6, .shift_lags = 0.0, .spread_lags = 0.0, .memory = 0});
  ASSERT_THAT(modelled.passes, SizeIs(4));
  EXPECT_LT(*modelled.result().mean_abs_error_mm, 0.03);
  EXPECT_GT(*plain.result().mean_abs_error_mm, 2.0 * *modelled.result().mean_abs_error_mm);
  EXPECT_LT(*modelled.contraction, *plain.contraction);
}

TEST_F(Converge, TamesTissueThatAnswersMoreThanTwice) {
  // Plain steps overshoot by more than they correct, and diverge.
  const FakeTissue tissue{.drift_mm = [](double a) { return -1.0 + 0.3 * std::sin(a); }, .gain = 2.2};
  const ConvergedCompensation plain = run(tissue, {.memory = 0, .trust_mm = 100.0});
  EXPECT_NE(plain.outcome, CompensationOutcome::Converged);
  const ConvergedCompensation result = run(tissue);
  EXPECT_EQ(result.outcome, CompensationOutcome::Converged) << to_string(result.outcome);
  EXPECT_LE(result.passes.size(), 4U);
  EXPECT_LT(*result.result().mean_abs_error_mm, 0.05);
}

TEST_F(Converge, StopsAtTheGrainOfTheMeshAndPutsNoneOfItIntoThePath) {
  FakeTissue tissue{.drift_mm = [](double) { return -1.2; }};
  tissue.grain_mm = [](double a) { return 0.15 * std::sin(90.0 * a) + 0.1 * std::cos(77.0 * a); };
  const ConvergedCompensation result = run(tissue, {.floor_mm = 0.11});
  EXPECT_EQ(result.outcome, CompensationOutcome::Converged);
  EXPECT_THAT(result.passes, SizeIs(2));
  EXPECT_THAT(result.result().offset_mm, Each(::testing::DoubleNear(1.2, kChordMm)));
  // Below what the mesh can do, it goes on to the last simulation and says so.
  const ConvergedCompensation more = run(tissue, {.floor_mm = 0.0, .least_move_mm = 0.0});
  EXPECT_THAT(more.passes, SizeIs(4));
  EXPECT_TRUE(more.outcome == CompensationOutcome::BudgetSpent || more.outcome == CompensationOutcome::BestKept);
  EXPECT_LE(*more.result().mean_abs_error_mm, *more.passes.back().mean_abs_error_mm);
}

TEST_F(Converge, KeepsTheBestPassWhereTissueJumps) {
  // From the second correction on this tissue answers with a jump outwards.
  int cuts = 0;
  const FakeTissue calm{.drift_mm = [](double) { return -1.0; }, .gain = 0.7};
  const ConvergedCompensation result = compensate_converging(path_, surface_, [&](const ToolPath& path) {
    PathErrors errors = calm.cut(path);
    if (++cuts > 2) {
      for (double& error : errors.signed_error_mm) error += 2.0;
    }
    return std::optional(errors);
  });
  EXPECT_EQ(result.outcome, CompensationOutcome::BestKept);
  EXPECT_THAT(result.passes, SizeIs(4));
  EXPECT_EQ(result.best, 1U);
  EXPECT_NEAR(result.path.waypoints[3].position_mm.head<2>().norm(), kRingRadiusMm + 1.0, kChordMm);
  EXPECT_LT(result.passes[3].max_move_mm, 0.5 * result.passes[2].max_move_mm + 1e-9) << "the trust region shrinks";
}

TEST_F(Converge, NoPathLeavesTheSafeRegion) {
  const ConvergedCompensation result = run({.drift_mm = [](double) { return 3.5; }});  // asks for 3.5 mm inwards
  EXPECT_THAT(result.result().is_limited, Each(1));
  for (const Waypoint& w : result.path.waypoints) {
    EXPECT_NEAR(nearest_on(path_.tumor_edge, w.position_mm).distance_mm, 2.7, 1e-6);
  }
  EXPECT_EQ(result.outcome, CompensationOutcome::AtRest) << "there is nowhere left to go";
  EXPECT_THAT(result.passes, SizeIs(2)) << "a path that was cut is not cut again";
  const ConvergedCompensation out =
      run({.drift_mm = [](double) { return -9.0; }}, {.region = {.max_offset_mm = 4.0}, .trust_mm = 10.0});
  EXPECT_THAT(out.result().offset_mm, Each(::testing::DoubleNear(4.0, 1e-9)));
}

TEST_F(Converge, APathThatWouldCrossItselfIsShortened) {
  const Contour kidney = testing::kidney();
  const SurfaceQuery surface(testing::flat_body());
  const ToolPath path = plan_ring(surface, kidney, {});
  // So far outwards that waypoints on the two lips of the dent would pass each other.
  const ConvergedCompensation result =
      compensate_converging(path, surface,
                            [&](const ToolPath& cut) {
                              PathErrors errors{.places = entry_contour(cut).points};
                              errors.signed_error_mm.assign(errors.places.size(), -4.9);
                              return std::optional(errors);
                            },
                            {.trust_mm = 6.0});
  EXPECT_FALSE(crosses_itself_in_view(entry_contour(result.path), -Vec3::UnitZ()));
  EXPECT_NO_THROW(check_path(result.path, surface, -Vec3::UnitZ()));
}

TEST_F(Converge, BridgesTheGapOfAnOpenContourAndCallsItNoSuccess) {
  const ConvergedCompensation result = run({.drift_mm = [](double) { return -1.0; }, .seen_from = kTurn / 6.0});
  EXPECT_NE(result.outcome, CompensationOutcome::Converged) << "a ring that stays open is not where it was intended";
  EXPECT_THAT(result.result().offset_mm, Each(::testing::DoubleNear(1.0, kChordMm)));
  const auto& bridged = result.passes[0].is_interpolated;
  EXPECT_NEAR(static_cast<double>(std::count(bridged.begin(), bridged.end(), 1)), 48.0 / 6.0 - 3.0, 1.1);
}

TEST_F(Converge, WithoutAMeasureOfTheFirstCutNothingIsMoved) {
  const ConvergedCompensation result =
      compensate_converging(path_, surface_, [](const ToolPath&) { return std::optional<PathErrors>(); });
  EXPECT_EQ(result.outcome, CompensationOutcome::NoMeasure);
  EXPECT_THAT(result.passes, SizeIs(1));
  EXPECT_FALSE(result.result().mean_abs_error_mm);
  EXPECT_EQ(result.path.waypoints.size(), 48U);
}

TEST_F(Converge, ALaterCutWithoutAMeasureIsTriedAgainWithAShorterMove) {
  const FakeTissue tissue{.drift_mm = [](double) { return -2.0; }};
  int cuts = 0;
  const ConvergedCompensation result = compensate_converging(path_, surface_, [&](const ToolPath& path) {
    return ++cuts == 2 ? std::optional<PathErrors>() : std::optional(tissue.cut(path));
  });
  ASSERT_GE(result.passes.size(), 3U);
  EXPECT_FALSE(result.passes[1].mean_abs_error_mm);
  EXPECT_NEAR(result.passes[2].max_move_mm, 1.0, kChordMm);
  EXPECT_EQ(result.outcome, CompensationOutcome::Converged) << to_string(result.outcome);
}

TEST_F(Converge, AimsAtTheRealCutWhereItsBiasIsKnown) {
  const FakeTissue tissue{.drift_mm = [](double) { return -1.0; }};
  const ConvergedCompensation constant = run(tissue, {.bias_mm = {0.3}});
  EXPECT_THAT(constant.result().offset_mm, Each(::testing::DoubleNear(0.7, kChordMm)));
  std::vector<double> profile(48, 0.0);
  for (std::size_t i = 0; i < 48; ++i) profile[i] = 0.4 * std::sin(kTurn * static_cast<double>(i) / 48.0);
  const ConvergedCompensation along = run(tissue, {.bias_mm = profile});
  EXPECT_NEAR(along.result().offset_mm[12], 1.0 - 0.4, 2.0 * kChordMm);
  EXPECT_NEAR(along.result().offset_mm[36], 1.0 + 0.4, 2.0 * kChordMm);
}

TEST_F(Converge, BelievesOfTheSimulatedErrorNoMoreThanItsShare) {
  const FakeTissue tissue{.drift_mm = [](double angle) { return -1.0 + 0.6 * std::cos(angle); }};
  // Half of the simulated error and its bias, and a residual beyond it: 0.5 (−1 + 0.6 cos + 0.2) − 0.3; the path starts
  // at −90°.
  const ConvergedCompensation half =
      run(tissue, {.bias_mm = {0.2}, .simulated_share = 0.5, .residual_mm = std::vector<double>(48, -0.3)});
  EXPECT_NEAR(half.result().offset_mm[12], 0.4 - 0.3 + 0.3, 2.0 * kChordMm);
  EXPECT_NEAR(half.result().offset_mm[36], 0.4 + 0.3 + 0.3, 2.0 * kChordMm);
  // None of it: the path follows the residual alone, and moves as far as that says.
  const ConvergedCompensation none =
      run(tissue, {.simulated_share = 0.0, .residual_mm = std::vector<double>(48, -0.3)});
  EXPECT_THAT(none.result().offset_mm, Each(::testing::DoubleNear(0.3, 2.0 * kChordMm)));
}

TEST_F(Converge, TellsEveryViolationOfItsSettings) {
  const ConvergenceSettings bad{.simulations = 1, .smoothing_mm = 0.0, .relaxation = 1.5, .trust_mm = -1.0};
  EXPECT_THAT(sentences(problems_of(bad)), ElementsAre(HasSubstr("simulations"), HasSubstr("relaxation"),
                                                       HasSubstr("smoothing_mm"), HasSubstr("trust_mm")));
  EXPECT_THROW(static_cast<void>(run({}, bad)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run({}, {.bias_mm = {0.1, 0.2}})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run({}, {.residual_mm = {0.1}})), InvalidArgument) << "one for each waypoint";
  ToolPath open = path_;
  open.is_closed = false;
  const MeasureCut measure = [](const ToolPath&) { return std::optional<PathErrors>(); };
  EXPECT_THROW(static_cast<void>(compensate_converging(open, surface_, measure)), InvalidArgument);
  const MeasureCut uneven = [](const ToolPath&) {
    return std::optional(PathErrors{.places = {Vec3::Zero()}, .signed_error_mm = {}});
  };
  EXPECT_THROW(static_cast<void>(compensate_converging(path_, surface_, uneven)), InvalidArgument);
}

/// The cut of the head CT: the correction of the lateral error made the kerf shallower.
TEST_F(Converge, DoesNotBuyTheLateralErrorWithDepth) {
  int cuts = 0;
  const MeasureCut shallower = [&](const ToolPath& path) {
    PathErrors errors = FakeTissue{}.cut(path);
    errors.shortfall_mm = cuts++ == 0 ? 0.9 : 2.5;
    return errors;
  };
  const ConvergedCompensation result = compensate_converging(path_, surface_, shallower);
  EXPECT_EQ(result.best, 0U);
  EXPECT_GT(*result.passes[0].mean_abs_error_mm, *result.passes[1].mean_abs_error_mm) << "the lateral error alone would choose another pass";
  EXPECT_EQ(result.passes[1].shortfall_mm, 2.5);
}

/// A ring that stays open by a hair's breadth a tenth of a millimetre off its course: the next pass starts there, not at the planned path.
TEST_F(Converge, GoesOnFromANearRingThatStayedOpen) {
  int cuts = 0;
  const FakeTissue drifting{.drift_mm = [](double angle) { return -1.2 + 0.6 * std::cos(2.0 * angle); }, .gain = 0.7};
  const MeasureCut opens_once = [&](const ToolPath& path) {
    PathErrors errors = drifting.cut(path);
    errors.is_success = cuts != 1;
    errors.open_layers = cuts++ == 1 ? 1 : 0;
    return errors;
  };
  const ConvergedCompensation result = compensate_converging(path_, surface_, opens_once);
  ASSERT_GE(result.passes.size(), 3U);
  EXPECT_GE(result.best, 2U);
  EXPECT_LT(*result.passes[2].mean_abs_error_mm, *result.passes[1].mean_abs_error_mm);
  EXPECT_TRUE(result.result().is_success);
}

/// The seam of a ring hangs on by a hair whatever the error says: a tenth of a millimetre farther out or in, it does
/// not.
TEST_F(Converge, MovesANearRingThatStaysOpenUntilItCloses) {
  const FakeTissue drifting{.drift_mm = [](double angle) { return -1.2 + 0.6 * std::cos(2.0 * angle); }, .gain = 0.7};
  int cuts = 0;
  const MeasureCut closes_at_last = [&](const ToolPath& path) {
    PathErrors errors = drifting.cut(path);
    errors.open_layers = cuts == 0 || cuts == 5 ? 0 : 1;
    errors.is_success = errors.open_layers == 0;
    ++cuts;
    return errors;
  };
  ConvergenceSettings settings;
  EXPECT_EQ(compensate_converging(path_, surface_, closes_at_last, settings).best, 0U) << "nothing near closes";
  cuts = 0;
  settings.more_simulations = 2;
  const ConvergedCompensation result = compensate_converging(path_, surface_, closes_at_last, settings);
  ASSERT_EQ(result.passes.size(), 6U);
  EXPECT_EQ(result.best, 5U);
  EXPECT_TRUE(result.result().is_success);
  EXPECT_LT(*result.result().mean_abs_error_mm, *result.passes[0].mean_abs_error_mm);
  double moved_mm = 0.0;
  for (std::size_t i = 0; i < result.passes[4].offset_mm.size(); ++i)
    moved_mm = std::max(moved_mm, std::abs(result.passes[4].offset_mm[i] - result.passes[5].offset_mm[i]));
  EXPECT_NEAR(moved_mm, 0.2, 1e-9) << "out, then in";
}

/// A pass 0.01 mm nearer whose kerf is a hair too shallow at one place loses to a sound one that is as near but for
/// that.
TEST_F(Converge, PrefersASoundPassToANearerOneThatTheVerdictIsAgainst) {
  const FakeTissue drifting{.drift_mm = [](double angle) { return -1.2 + 0.6 * std::cos(2.0 * angle); }, .gain = 0.7};
  for (const VerdictStatus status : {VerdictStatus::Caution, VerdictStatus::Refused}) {
    int cuts = 0;
    const MeasureCut only_the_second_is_sound = [&](const ToolPath& path) {
      PathErrors errors = drifting.cut(path);
      errors.verdict = cuts++ == 1 ? VerdictStatus::Ok : status;
      return errors;
    };
    const ConvergedCompensation result =
        compensate_converging(path_, surface_, only_the_second_is_sound, {.tolerance_mm = 1e-6, .least_move_mm = 0.0});
    ASSERT_EQ(result.passes.size(), 4U);
    EXPECT_LT(*result.passes[2].mean_abs_error_mm, *result.passes[1].mean_abs_error_mm)
        << "the error alone would choose another pass";
    EXPECT_EQ(result.best, 1U);
    EXPECT_EQ(result.passes[2].verdict, status);
  }
}

/// An error within the tolerance does not end the iteration while the verdict is against the cut: the ring is made
/// again beside it.
TEST_F(Converge, GoesOnWhileTheVerdictIsAgainstTheNearestPass) {
  const FakeTissue drifting{.drift_mm = [](double) { return -1.2; }};
  int cuts = 0;
  const MeasureCut sound_at_last = [&](const ToolPath& path) {
    PathErrors errors = drifting.cut(path);
    errors.verdict = cuts == 1 ? VerdictStatus::Caution : VerdictStatus::Ok;
    ++cuts;
    return errors;
  };
  ConvergenceSettings settings{.more_simulations = 2, .tolerance_mm = 0.15};
  const ConvergedCompensation result = compensate_converging(path_, surface_, sound_at_last, settings);
  EXPECT_EQ(result.outcome, CompensationOutcome::Converged) << to_string(result.outcome);
  ASSERT_EQ(result.passes.size(), 3U);
  EXPECT_EQ(result.best, 2U);
}

/// Not even the planned ring closed: the nearest is mended all the same, unless it lacks so much that a tenth of a
/// millimetre is no help.
TEST_F(Converge, MendsTheNearestRingWhereNoneCloses) {
  for (const int open : {1, 2}) {
    int cuts = 0;
    const FakeTissue drifting{.drift_mm = [](double angle) { return -1.2 + 0.6 * std::cos(2.0 * angle); }, .gain = 0.7};
    const MeasureCut closes_at_last = [&](const ToolPath& path) {
      PathErrors errors = drifting.cut(path);
      errors.open_layers = cuts++ == 4 ? 0 : open;
      errors.is_success = errors.open_layers == 0;
      return errors;
    };
    ConvergenceSettings settings{.more_simulations = 2, .tolerance_mm = 1e-3};
    const ConvergedCompensation result = compensate_converging(path_, surface_, closes_at_last, settings);
    EXPECT_EQ(result.result().is_success, open == 1);
    EXPECT_EQ(result.passes.size() > 4, open == 1);
  }
}

TEST_F(Converge, PrefersThePassThatLeavesFewerLayersOpen) {
  int cuts = 0;
  const MeasureCut opens = [&](const ToolPath& path) {
    PathErrors errors = FakeTissue{}.cut(path);
    errors.is_success = false;
    errors.open_layers = cuts++ == 0 ? 1 : 3;
    return errors;
  };
  EXPECT_EQ(compensate_converging(path_, surface_, opens).best, 0U);
}

}  // namespace
}  // namespace incise
