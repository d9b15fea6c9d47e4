#include "cutting/ring_in_a_block.hpp"
#include "support/monitors.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/divided_mesh.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

class Incision : public testing::RingInABlock {};

TEST_F(Incision, ARingInFrozenTissueClosesOnThePath) {
  settings_.cut.bond_stiffness_kpa_mm2 = 0.0;
  const IncisionResult result = cut(ring(4.0));
  EXPECT_EQ(result.outcome, Outcome::Success);
  ASSERT_TRUE(result.centerline.has_value());
  EXPECT_TRUE(*result.is_closed_loop);
  EXPECT_NEAR(mean_radius(*result.centerline), kRadiusMm, 0.1);  // a tenth of the cells' edge
  for (const Vec3& p : result.centerline->points) EXPECT_NEAR(p.z(), 8.0, 1e-6) << "the mid-line lies on the surface";
  ASSERT_TRUE(result.inner_edge.has_value());
  EXPECT_LT(mean_radius(*result.inner_edge), kRadiusMm - 0.8);
}

TEST_F(Incision, HeldTissueDriftsInwards) {
  settings_.cut.bond_stiffness_kpa_mm2 = 300.0;
  settings_.cut.dullness = 6.0;
  const IncisionResult result = cut(ring(4.0));
  ASSERT_TRUE(result.centerline.has_value());
  EXPECT_LT(mean_radius(*result.centerline), kRadiusMm - 0.1);
  EXPECT_GT(result.peak_tool_force_mn, 50.0);
  EXPECT_TRUE(result.is_at_rest);
}

// Speed and dullness act through their product alone, so the same tets go in the same order at any speed.
TEST_F(Incision, IsTheSameForEverySpeedIfSpeedTimesDullnessIs) {
  settings_.cut.bond_stiffness_kpa_mm2 = 300.0;
  std::vector<TetId> at_13;
  for (const double speed : {13.0, 0.5, 100.0}) {
    settings_.cut.speed_mm_s = speed;
    settings_.cut.dullness = 13.0 * 6.0 / speed;
    const IncisionResult result = cut(ring(4.0));
    std::vector<TetId> order;
    for (const Removal& removal : result.record.removals) order.push_back(removal.tet);
    ASSERT_GT(order.size(), 100U);
    if (at_13.empty()) at_13 = order;
    EXPECT_EQ(order, at_13) << speed << " mm/s";
  }
}

TEST_F(Incision, EveryStepIsSolvedInTissueThatHardlyChangesItsVolume) {
  for (const double poissons_ratio : {0.499, 0.4999}) {
    Material stiff{.poissons_ratio = poissons_ratio};
    model_ = make_tissue_model(make_block({32, 32, 8}, {24, 24, 6}), stiff,
                               {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
    const IncisionResult result = cut(ring(4.0));
    EXPECT_EQ(result.unconverged_steps, 0U) << poissons_ratio;
    EXPECT_EQ(result.outcome, Outcome::Success) << poissons_ratio;
    EXPECT_LT(result.held_back_vertices, 100U) << poissons_ratio;
  }
}

TEST_F(Incision, AnArcThatDoesNotGoRoundIsAnOpenLoop) {
  ToolPath path = ring(4.0);
  path.waypoints.resize(20);  // the way back from the last waypoint to the first is straight and misses the middle
  path.waypoints.back().position_mm = path.waypoints.front().position_mm + Vec3(0.0, 0.5, 0.0);
  for (std::size_t i = 10; i < 20; ++i)
    path.waypoints[i].position_mm = path.waypoints[19 - i].position_mm + Vec3(0.3, 0.3, 0.0);
  const IncisionResult result = cut(path);
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
  EXPECT_FALSE(*result.is_closed_loop);
  EXPECT_FALSE(result.inner_edge.has_value());
}

TEST_F(Incision, AToolAboveTheSurfaceCutsNothingAndSaysSo) {
  ToolPath path = ring(1.0);
  for (Waypoint& waypoint : path.waypoints) waypoint.position_mm.z() += 5.0;
  const IncisionResult result = cut(path);
  EXPECT_TRUE(result.record.removals.empty());
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
}

TEST_F(Incision, ABladeThatHeadsAlongTheRingCutsItClosed) {
  settings_.tool = Blade{.thickness_mm = 1.6, .width_mm = 3.0};
  settings_.cut.bond_stiffness_kpa_mm2 = 0.0;
  const IncisionResult result = cut(ring(4.0));
  EXPECT_EQ(result.outcome, Outcome::Success);
  ASSERT_TRUE(result.centerline.has_value());
  EXPECT_NEAR(mean_radius(*result.centerline), kRadiusMm, 0.2);
}

TEST_F(Incision, ABallAtTheSurfaceCutsAGrooveThatCloses) {
  settings_.tool = Ball{.diameter_mm = 2.0};
  settings_.cut.bond_stiffness_kpa_mm2 = 0.0;
  const IncisionResult result = cut(ring(0.5));
  EXPECT_EQ(result.outcome, Outcome::Success);
  for (const Removal& removal : result.record.removals)
    EXPECT_GT(removal.centroid_mm.z(), 8.0 - 0.5 - 1.0 - 0.4 - 1.4) << "no deeper than the ball";
}

TEST_F(Incision, ABallLedDeepBelowTheSurfaceTunnelsAndLeavesTheRingOpen) {
  settings_.tool = Ball{.diameter_mm = 1.6};
  settings_.cut.bond_stiffness_kpa_mm2 = 0.0;
  const IncisionResult result = cut(ring(5.0));
  EXPECT_GT(result.record.removals.size(), 100U);
  EXPECT_EQ(result.outcome, Outcome::OpenLoop);
}

TEST_F(Incision, CountsTheSlipsAndThePeakTorqueOfAllSteps) {
  settings_.cut.slip_mm = 0.2;
  const IncisionResult result = cut(ring(4.0));
  std::size_t slipped = 0;
  double torque = 0.0;
  for (const CutStepLog& step : result.steps) {
    slipped += step.slipped;
    torque = std::max(torque, step.tool_torque_mn_mm.norm());
  }
  EXPECT_GT(slipped, 0U);
  EXPECT_EQ(result.slipped_bonds, slipped);
  EXPECT_GT(torque, 0.0);
  EXPECT_EQ(result.peak_tool_torque_mn_mm, torque);
}

TEST_F(Incision, AnOpenCutHasNoLoopToClose) {
  ToolPath path{.is_closed = false};
  for (int i = 0; i < 8; ++i) {
    Waypoint waypoint{.position_mm = Vec3(8.0 + 2.0 * i, 16.0, 8.0), .depth_mm = 4.0};
    path.waypoints.push_back(waypoint);
  }
  settings_.cut.bond_stiffness_kpa_mm2 = 0.0;
  const IncisionResult result = cut(path);
  EXPECT_EQ(result.outcome, Outcome::Success);
  EXPECT_FALSE(result.is_closed_loop.has_value());
  ASSERT_TRUE(result.centerline.has_value());
  EXPECT_FALSE(result.centerline->is_closed);
  for (const Vec3& p : result.centerline->points) EXPECT_NEAR(p.y(), 16.0, 0.5);
}

TEST_F(Incision, KeepsTheFramesThatWereAskedForFromFirstToLast) {
  settings_.frames = 5;
  const IncisionResult result = cut(ring(4.0));
  ASSERT_EQ(result.frames.size(), 5U);
  EXPECT_EQ(result.frames.front().time_s, 0.0);
  EXPECT_FALSE(result.frames.back().is_tool_in);
  EXPECT_EQ(divide_at_kerf(model_, result.final_state).is_left(result.frames.back().step),
            result.final_state.tissue.is_live);
}

TEST_F(Incision, SaysWhenItsStepsAreTooFewForTheFrames) {
  const auto warnings_with = [this](int frames) {
    settings_.frames = frames;
    testing::RecordingMonitor listener;
    Workers workers(1);
    const IncisionResult result =
        simulate_incision(model_, rest_state(model_), ring(4.0), settings_, workers, listener);
    EXPECT_LE(result.frames.size(), static_cast<std::size_t>(frames));
    EXPECT_EQ(listener.warnings.empty(), result.frames.size() == static_cast<std::size_t>(frames)) << frames;
    return listener.warnings;
  };
  EXPECT_TRUE(warnings_with(40).empty());
  const std::vector<std::string> said = warnings_with(400);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("frames instead of 400"), std::string::npos) << said[0];
}

TEST_F(Incision, SaysThatItBrokeOffWhereAPositionIsNoLongerFinite) {
  // So soft, and at one corner so loaded, that the square of a displacement is beyond all numbers while that of a force
  // is not.
  Material soft{.youngs_modulus_kpa = 1e-6};
  model_ = make_tissue_model(make_block({32, 32, 8}, {24, 24, 6}), soft,
                             {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
  model_.dead_load_mn.back().z() = 1e152;
  settings_.cut.residual_tolerance = 1e-3;
  testing::RecordingMonitor listener;
  Workers workers(1);
  const IncisionResult result = simulate_incision(model_, rest_state(model_), ring(4.0), settings_, workers, listener);
  EXPECT_EQ(result.outcome, Outcome::NotConverged);
  ASSERT_FALSE(listener.warnings.empty());
  EXPECT_NE(listener.warnings[0].find("the cut ends at "), std::string::npos) << listener.warnings[0];
  EXPECT_NE(listener.warnings[0].find("no longer finite"), std::string::npos) << listener.warnings[0];
}

TEST_F(Incision, CountsTheVerticesThatWereHeldBack) {
  settings_.cut.bond_stiffness_kpa_mm2 = 300.0;
  settings_.cut.dullness = 6.0;
  const auto held_back_with = [this](double max_step_mm) {
    settings_.cut.max_step_mm = max_step_mm;
    Monitor silent;
    Workers workers(1);
    return simulate_incision(model_, rest_state(model_), ring(4.0), settings_, workers, silent).held_back_vertices;
  };
  EXPECT_EQ(held_back_with(1e4), 0U);
  EXPECT_GT(held_back_with(0.05), 100U) << "tissue is dragged 0.8 mm in a step";
}

TEST_F(Incision, TakesWhatRoundingLeavesOfTheProgramWithItsLastStep) {
  const double advance = settings_.cut.advance_per_step_mm;
  const auto steps_of = [&] {
    return ToolProgram(ring(4.0), settings_.cut, settings_.tool).duration_s() / settings_.cut.step_s();
  };
  settings_.cut.overlap_mm +=
      (1.0 - std::fmod(steps_of(), 1.0) + 1e-4) * advance;  // a whole number of steps and a ten-thousandth of one
  const double whole = std::floor(steps_of());
  ASSERT_NEAR(steps_of() - whole, 1e-4, 1e-9);
  const IncisionResult result = cut(ring(4.0));
  double before = 0.0;
  std::size_t with_tool = 0;
  for (const CutStepLog& step : result.steps) {
    EXPECT_GT(step.time_s - before, 0.99 * settings_.cut.step_s()) << "at " << step.time_s << " s";
    before = step.time_s;
    if (step.time_s < (whole + 0.5) * settings_.cut.step_s()) ++with_tool;
  }
  EXPECT_EQ(with_tool, static_cast<std::size_t>(whole));
  EXPECT_NEAR(result.steps[with_tool - 1].time_s, steps_of() * settings_.cut.step_s(), 1e-9)
      << "the program is carried out to its end";
}

TEST_F(Incision, StopsWhereItIsWhenAskedTo) {
  StopAtHalf monitor;
  Workers workers(1);
  const IncisionResult result = simulate_incision(model_, rest_state(model_), ring(4.0), settings_, workers, monitor);
  EXPECT_EQ(result.outcome, Outcome::Cancelled);
}

TEST_F(Incision, ATumourThatCannotBeMeasuredIsRefusedBeforeTheCut) {
  const auto refusal = [this](const ToolPath& path) {
    testing::RecordingMonitor recorder;
    Workers workers(1);
    const std::string message = testing::refusal_of<InvalidArgument>(
        [&] { return simulate_incision(model_, rest_state(model_), path, settings_, workers, recorder); });
    EXPECT_TRUE(recorder.fractions.empty());
    return message;
  };
  ToolPath path = ring(4.0);
  path.tumor_edge.points[3].z() += 0.6;
  const std::string off_tissue = refusal(path);
  EXPECT_NE(off_tissue.find("point 3 of the tumour edge lies farther than 0.5 mm from the tissue"), std::string::npos)
      << off_tissue;
  settings_.tumor_surface = boundary_surface(make_block(Vec3::Ones(), {1, 1, 1}));
  for (Triangle& t : settings_.tumor_surface.triangles) std::swap(t[0], t[1]);  // inside out
  const std::string no_volume = refusal(ring(4.0));
  EXPECT_NE(no_volume.find("expected a tumour surface that encloses a volume, found -"), std::string::npos)
      << no_volume;
}

TEST_F(Incision, SettingsThatCannotBeUsedAreListed) {
  settings_.cut.speed_mm_s = 0.0;
  settings_.frames = -1;
  EXPECT_THAT(testing::refusal_of<InvalidArgument>([&] { return cut(ring(4.0)); }),
              ::testing::AllOf(::testing::HasSubstr("speed_mm_s"), ::testing::HasSubstr("frames")));
}

}  // namespace
}  // namespace incise
