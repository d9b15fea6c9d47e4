#include "contact.hpp"

#include <incise/cutting/carving.hpp>
#include <incise/cutting/tool_program.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

namespace incise {
namespace {

/// A 20 x 10 x 8 mm block with cells of 1 mm, held at its underside; the needle stands in its middle.
class Carve : public ::testing::Test {
 protected:
  Carve()
      : model_(make_tissue_model(make_block({20, 10, 8}, {20, 10, 8}), Material{},
                                 {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(21, 11, 0.1))}}})) {}

  static ToolPose standing_at(double x) { return {Vec3(x, 5.2, 4.0), -Vec3::UnitZ()}; }

  CutState run(const CutSettings& settings, double from_x, double to_x, int steps, double step_s, int threads = 1) {
    Workers workers(threads);
    CutState state = begin_cut(model_, rest_state(model_), standing_at(from_x));
    CutWorkspace workspace(model_, state.tissue.positions);
    for (int i = 1; i <= steps; ++i) {
      const ToolPose next = standing_at(from_x + (to_x - from_x) * i / steps);
      const CutStepReport report = advance(model_, settings, needle_, state, workspace, next, step_s, workers);
      EXPECT_TRUE(report.solve.converged);
      EXPECT_TRUE(report.is_finite);
    }
    return state;
  }

  static std::vector<TetId> removed(const CutState& state) {
    std::vector<TetId> tets;
    for (const Removal& removal : state.record.removals) tets.push_back(removal.tet);
    return tets;
  }

  TissueModel model_;
  Needle needle_;
};

TEST_F(Carve, RemovesATetOnlyAfterTheRequiredDwell) {
  const CutSettings settings;  // 9 x 0.02 s
  EXPECT_TRUE(run(settings, 10.3, 10.3, 8, 0.02).record.removals.empty());
  const CutState after = run(settings, 10.3, 10.3, 9, 0.02);
  EXPECT_FALSE(after.record.removals.empty());
  for (const Removal& removal : after.record.removals) EXPECT_NEAR(removal.time_s, 0.18, 1e-12);
}

TEST_F(Carve, ATetTouchedForATenthOfAPercentMoreGoesAndOneForAPercentLessStaysAtAnyStep) {
  const CutSettings settings;
  for (const int steps : {1, 4, 9, 23}) {
    EXPECT_FALSE(run(settings, 10.3, 10.3, steps, 1.001 * settings.dwell_s() / steps).record.removals.empty()) << steps;
    EXPECT_TRUE(run(settings, 10.3, 10.3, steps, 0.99 * settings.dwell_s() / steps).record.removals.empty()) << steps;
  }
}

TEST_F(Carve, WhatIsRemovedAtRestDoesNotDependOnTheStep) {
  CutSettings settings{.bond_stiffness_kpa_mm2 = 0.0};
  EXPECT_EQ(removed(run(settings, 10.3, 10.3, 9, 0.02)), removed(run(settings, 10.3, 10.3, 36, 0.005)));
}

TEST_F(Carve, EveryTetThatIsRemovedWasWithinReachOfTheNeedle) {
  CutSettings settings{.bond_stiffness_kpa_mm2 = 0.0};
  const CutState state = run(settings, 10.3, 10.3, 10, 0.02);
  std::set<TetId> gone;
  for (const Removal& removal : state.record.removals) {
    if (removal.cause != RemovalCause::Dwell) continue;
    const Tet& t = model_.mesh.tets[removal.tet.index()];
    const auto& x = model_.mesh.vertices;
    const ToolPose tool = standing_at(10.3);
    const double distance = distance_to_segment({x[t[0].index()], x[t[1].index()], x[t[2].index()], x[t[3].index()]}, tool.tip_mm,
                                                tool.tip_mm - needle_.length_mm * tool.axis);
    // Gravity is off and nothing is held, so the tissue has not moved.
    EXPECT_LE(distance, needle_.radius_mm() + settings.reach_mm + 1e-9);
    gone.insert(removal.tet);
  }
  EXPECT_GT(gone.size(), 20U);
}

TEST_F(Carve, KeepsTheBalanceOfRestVolume) {
  const CutState state = run(CutSettings{}, 5.0, 15.0, 50, 0.02);
  double live = 0.0;
  for (std::size_t tet = 0; tet < model_.mesh.tets.size(); ++tet) {
    if (state.tissue.is_live[tet] != 0) live += model_.volumes_mm3[tet];
  }
  EXPECT_GT(state.record.removed_volume_mm3(), 10.0);
  EXPECT_NEAR(live + state.record.removed_volume_mm3(), 20.0 * 10.0 * 8.0, 1e-9);
}

TEST_F(Carve, RemovesNoTetTwice) {
  const std::vector<TetId> tets = removed(run(CutSettings{}, 5.0, 15.0, 50, 0.02));
  EXPECT_EQ(std::set<TetId>(tets.begin(), tets.end()).size(), tets.size());
}

TEST_F(Carve, GivesTheSameRecordAndPositionsAtAnyThreadCount) {
  const CutState one = run(CutSettings{}, 5.0, 12.0, 35, 0.02, 1);
  for (const int threads : {2, 4}) {
    const CutState many = run(CutSettings{}, 5.0, 12.0, 35, 0.02, threads);
    EXPECT_EQ(removed(one), removed(many)) << threads << " threads";
    EXPECT_EQ(one.tissue.positions, many.tissue.positions) << threads << " threads";
  }
}

TEST_F(Carve, FromARenewalStepANewWorkspaceGivesTheSameBits) {
  Workers workers(1);
  const CutSettings settings;
  CutState straight = begin_cut(model_, rest_state(model_), standing_at(5.0));
  CutWorkspace used(model_, model_.mesh.vertices);
  CutState resumed;
  std::optional<CutWorkspace> fresh;
  int renewals = 0;
  for (int i = 1; i <= 50; ++i) {
    if (is_renewal_step(straight)) {  // the one run leaves its workspace and what became of it behind, the other goes on
      resumed = straight;
      fresh.emplace(model_, model_.mesh.vertices);
      ++renewals;
    }
    const ToolPose next = standing_at(5.0 + 0.2 * i);
    static_cast<void>(advance(model_, settings, needle_, straight, used, next, 0.02, workers));
    static_cast<void>(advance(model_, settings, needle_, resumed, *fresh, next, 0.02, workers));
    ASSERT_EQ(straight.tissue.positions, resumed.tissue.positions) << "step " << i;
  }
  EXPECT_EQ(renewals, 3);
  EXPECT_FALSE(straight.record.removals.empty());
}

TEST_F(Carve, DragsHeldTissueAlongWithTheNeedle) {
  CutSettings settings;
  settings.dullness = 1000.0;  // nothing is removed
  const CutState state = run(settings, 10.0, 10.8, 5, 0.02);
  double along = 0.0;
  double farthest = 0.0;
  for (std::size_t v = 0; v < model_.mesh.vertices.size(); ++v) {
    along = std::max(along, (state.tissue.positions[v] - model_.mesh.vertices[v]).x());
    farthest = std::max(farthest, (state.tissue.positions[v] - model_.mesh.vertices[v]).norm());
  }
  EXPECT_GT(along, 0.2);
  EXPECT_LT(farthest, 1.5);
  EXPECT_TRUE(state.record.removals.empty());
}

TEST_F(Carve, WithoutBondsTheNeedleMovesNothing) {
  CutSettings settings{.dullness = 1000.0, .bond_stiffness_kpa_mm2 = 0.0};
  const CutState state = run(settings, 10.0, 10.8, 5, 0.02);
  EXPECT_EQ(state.tissue.positions, model_.mesh.vertices);
}

TEST_F(Carve, TissueReturnsWhenTheToolIsOut) {
  CutSettings settings{.dullness = 1000.0};
  Workers workers(1);
  CutState state = run(settings, 10.0, 10.8, 5, 0.02);
  CutWorkspace workspace(model_, state.tissue.positions);
  for (int i = 0; i < 30; ++i) static_cast<void>(advance(model_, settings, needle_, state, workspace, std::nullopt, 0.02, workers));
  double farthest = 0.0;
  for (std::size_t v = 0; v < model_.mesh.vertices.size(); ++v) {
    farthest = std::max(farthest, (state.tissue.positions[v] - model_.mesh.vertices[v]).norm());
  }
  EXPECT_LT(farthest, 0.01);  // the linear solves stop at 1 % of 5 mN
  EXPECT_TRUE(state.bonds.empty());
}

/// Much of the body moves farther on its way to rest than a vertex may in a step with the tool in.
TEST(Relaxation, ABarLetGoFromFarAwayComesToRest) {
  const TissueModel bar = make_tissue_model(make_block({40, 6, 6}, {20, 3, 3}), Material{},
                                            {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(0.1, 7, 7))}}});
  Workers workers(1);
  TissueState bent = rest_state(bar);
  for (Vec3& p : bent.positions) p.y() += 0.012 * p.x() * p.x();  // its end is 19 mm away
  const Points rest = bar.mesh.vertices;
  CutState state = begin_cut(bar, bent, {Vec3(20, 3, 30), -Vec3::UnitZ()});
  CutWorkspace workspace(bar, state.tissue.positions);
  double moved_mm = 1.0;
  int steps = 0;
  for (; steps < 60 && moved_mm > 1e-3; ++steps) {
    const CutStepReport report = advance(bar, CutSettings{}, Needle{}, state, workspace, std::nullopt, 0.02, workers);
    moved_mm = report.max_step_mm;
    EXPECT_EQ(report.held_back_vertices, 0U);
  }
  EXPECT_LT(steps, 30);
  // Solves end at a residual of 0.75 mN; a force of 3 EI / L³ = 0.35 mN at its end bends the bar by 1 mm.
  for (std::size_t v = 0; v < rest.size(); ++v) EXPECT_LT((state.tissue.positions[v] - rest[v]).norm(), 0.5) << v;
}

TEST_F(Carve, TwiceThePowerHalvesTheDwell) {
  CutSettings settings;
  settings.power_w = 2.0 * settings.reference_power_w;
  EXPECT_FALSE(run(settings, 10.3, 10.3, 1, 0.501 * settings.dwell_s()).record.removals.empty());
  EXPECT_TRUE(run(settings, 10.3, 10.3, 1, 0.495 * settings.dwell_s()).record.removals.empty());
}

TEST_F(Carve, TissueOfTwiceTheToughnessTakesTwiceTheDwell) {
  model_.toughness.assign(model_.mesh.tets.size(), 2.0);
  CutSettings settings;
  EXPECT_FALSE(run(settings, 10.3, 10.3, 1, 2.002 * settings.dwell_s()).record.removals.empty());
  EXPECT_TRUE(run(settings, 10.3, 10.3, 1, 1.98 * settings.dwell_s()).record.removals.empty());
}

TEST_F(Carve, OnlyTheTenderPartOfABodyOfTwoKindsIsCutAtOnce) {
  model_.toughness.assign(model_.mesh.tets.size(), 1.0);
  for (std::size_t tet = 0; tet < model_.mesh.tets.size(); ++tet) {
    const Tet& t = model_.mesh.tets[tet];
    double middle = 0.0;
    for (const VertexId v : t) middle += 0.25 * model_.mesh.vertices[v.index()].x();
    if (middle > 10.3) model_.toughness[tet] = 5.0;
  }
  CutSettings settings{.bond_stiffness_kpa_mm2 = 0.0};
  const CutState state = run(settings, 10.3, 10.3, 1, 2.0 * settings.dwell_s());
  EXPECT_GT(state.record.removals.size(), 10U);
  for (const Removal& removal : state.record.removals) {
    if (removal.cause == RemovalCause::Dwell) {
      EXPECT_LE(removal.centroid_mm.x(), 10.3);
    }
  }
}

TEST_F(Carve, HeldTissueTearsWhenTheToolWorksOnIt) {
  CutSettings settings;
  settings.dullness = 1000.0;  // contact alone removes nothing
  EXPECT_TRUE(run(settings, 10.0, 11.5, 6, 0.02).record.removals.empty());
  settings.tear_energy_kpa = 5.0;
  const CutState state = run(settings, 10.0, 11.5, 6, 0.02);
  ASSERT_FALSE(state.record.removals.empty());
  EXPECT_EQ(state.record.removals.front().cause, RemovalCause::Tear);
}

TEST_F(Carve, WhereContactDoesMostOfTheDoseTheCauseIsDwell) {
  CutSettings settings{.tear_energy_kpa = 1e6};
  const CutState state = run(settings, 10.0, 12.6, 10, 0.02);
  ASSERT_FALSE(state.record.removals.empty());
  for (const Removal& removal : state.record.removals) EXPECT_NE(removal.cause, RemovalCause::Tear);
}

TEST_F(Carve, TheWorkOfAToolThatStandsStillIsNothing) {
  CutSettings settings{.dullness = 1000.0, .tear_energy_kpa = 1e-3};
  EXPECT_TRUE(run(settings, 10.3, 10.3, 20, 0.02).record.removals.empty());
}

TEST_F(Carve, TissueThatSlipsStaysWithinTheSlipBehindTheTool) {
  CutSettings settings{.dullness = 1000.0, .slip_mm = 0.1};
  Workers workers(1);
  CutState state = begin_cut(model_, rest_state(model_), standing_at(10.0));
  CutWorkspace workspace(model_, state.tissue.positions);
  for (const double x : {10.25, 10.5, 10.75, 11.0, 11.25, 11.5, 11.5}) {  // the tool pulls from where it stood before the step
    static_cast<void>(advance(model_, settings, needle_, state, workspace, standing_at(x), 0.02, workers));
  }
  EXPECT_FALSE(state.bonds.empty());
  const ToolPose tool = standing_at(11.5);
  for (const Bond& bond : state.bonds) {
    const auto corners = corners_of(state.tissue.positions, model_.mesh.tets[bond.tet.index()]);
    const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    EXPECT_LE((held_directions(needle_, tool) * (middle - tool.tip_mm - bond.offset_mm)).norm(), 0.1 + 1e-9);
  }
}

TEST_F(Carve, ASlipBoundsTheForceAndIsCounted) {
  CutSettings settings{.dullness = 1000.0};
  Workers workers(1);
  std::array<double, 2> peak{};
  std::size_t slipped = 0;
  for (const bool can_slip : {false, true}) {
    if (can_slip) settings.slip_mm = 0.05;
    CutState state = begin_cut(model_, rest_state(model_), standing_at(10.0));
    CutWorkspace workspace(model_, state.tissue.positions);
    for (int i = 1; i <= 6; ++i) {
      const CutStepReport report = advance(model_, settings, needle_, state, workspace, standing_at(10.0 + 0.25 * i), 0.02, workers);
      peak[can_slip ? 1 : 0] = std::max(peak[can_slip ? 1 : 0], report.tool_force_mn.norm());
      slipped += report.slipped;
    }
  }
  EXPECT_LT(peak[1], 0.5 * peak[0]);
  EXPECT_GT(slipped, 0U);
}

TEST_F(Carve, TheTissuePullsTheNeedleBackAndTurnsItAboutItsTip) {
  CutSettings settings{.dullness = 1000.0};
  Workers workers(1);
  CutState state = begin_cut(model_, rest_state(model_), standing_at(10.0));
  CutWorkspace workspace(model_, state.tissue.positions);
  CutStepReport report;
  for (int i = 1; i <= 4; ++i) report = advance(model_, settings, needle_, state, workspace, standing_at(10.0 + 0.2 * i), 0.02, workers);
  EXPECT_LT(report.tool_force_mn.x(), -10.0);
  // Held tissue lies from 0.75 mm below the tip to the surface, 4 mm above it, and pulls towards -x: about y, -force times height.
  const double height = report.tool_torque_mn_mm.y() / report.tool_force_mn.x();
  EXPECT_GT(height, 0.5);
  EXPECT_LT(height, 4.0);
}

TEST_F(Carve, ABallHoldsTissueAlsoAlongItsAxisAndANeedleDoesNot) {
  CutSettings settings{.dullness = 1000.0};
  Workers workers(1);
  for (const Tool& tool : {Tool{Ball{.diameter_mm = 1.5}}, Tool{Needle{}}}) {
    ToolPose pose = standing_at(10.3);
    CutState state = begin_cut(model_, rest_state(model_), pose);
    CutWorkspace workspace(model_, state.tissue.positions);
    CutStepReport report;
    for (int i = 0; i < 4; ++i) {
      pose.tip_mm.z() += 0.1;
      report = advance(model_, settings, tool, state, workspace, pose, 0.02, workers);
    }
    if (std::holds_alternative<Ball>(tool)) {
      EXPECT_LT(report.tool_force_mn.z(), -1.0);
    } else {
      EXPECT_EQ(report.tool_force_mn.z(), 0.0);
    }
  }
}

/// A 3 mm cube of 162 tets that does not move, and a needle that comes in at 13 mm/s, stays, and goes out on the other side.
class Passage : public ::testing::Test {
 protected:
  static constexpr double kSpeed = 13.0;  // mm/s
  static constexpr double kFrom = -2.0;
  static constexpr double kStand = 1.3;
  static constexpr double kTo = 5.0;

  Passage() : model_(make_tissue_model(make_block({3, 3, 3}, {3, 3, 3}), Material{}, {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(4, 4, 0.1))}}})) {
    settings_.bond_stiffness_kpa_mm2 = 0.0;
  }
  static ToolPose at(double x) { return {Vec3(x, 1.7, 1.2), -Vec3::UnitZ()}; }
  static ToolPose pose(double time_s, double stay_s) {
    const double arrival = (kStand - kFrom) / kSpeed;
    if (time_s < arrival) return at(kFrom + kSpeed * time_s);
    return at(std::min(kTo, kStand + kSpeed * std::max(0.0, time_s - arrival - stay_s)));
  }
  /// For how long a needle that does not stay touches a tet, s.
  double passing_s(TetId tet) const {
    const auto corners = corners_of(model_.mesh.vertices, model_.mesh.tets[tet.index()]);
    constexpr int kSamples = 40000;
    int touched = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double x = kFrom + (kTo - kFrom) * (i + 0.5) / kSamples;
      if (distance_to_core(corners, ToolCore(Needle{}, at(x))) <= 0.75) ++touched;
    }
    return (kTo - kFrom) / kSpeed * touched / kSamples;
  }
  /// Whether contact removes a tet that is touched for `touched_s` in all, `advance_mm` a step.
  bool goes(TetId tet, double passing_s, double touched_s, double advance_mm) {
    const double stay_s = touched_s - passing_s;
    const double end_s = (kTo - kFrom) / kSpeed + stay_s;
    Workers workers(1);
    CutState state = begin_cut(model_, rest_state(model_), at(kFrom));
    CutWorkspace workspace(model_, state.tissue.positions);
    while (state.time_s < end_s - 1e-9) {
      const double step_s = std::min(advance_mm / kSpeed, end_s - state.time_s);
      static_cast<void>(advance(model_, settings_, Needle{}, state, workspace, pose(state.time_s + step_s, stay_s), step_s, workers));
    }
    return std::any_of(state.record.removals.begin(), state.record.removals.end(),
                       [&](const Removal& r) { return r.tet == tet && r.cause == RemovalCause::Dwell; });
  }
  TissueModel model_;
  CutSettings settings_;
};

TEST_F(Passage, ATetTouchedForATenthOfAPercentMoreGoesAndOneForAPercentLessStaysAtAnyStep) {
  std::size_t tested = 0;
  for (std::size_t i = 0; i < model_.mesh.tets.size() && tested < 4; ++i) {
    const TetId tet(i);
    const auto corners = corners_of(model_.mesh.vertices, model_.mesh.tets[i]);
    if (distance_to_core(corners, ToolCore(Needle{}, at(kStand))) > 0.1) continue;  // touched before, in and after the stay
    ++tested;
    const double passing = passing_s(tet);
    settings_.dullness = 1.5 * passing / settings_.reference_step_s;
    for (const double advance_mm : {0.01, 0.13, 0.26, 0.52}) {
      EXPECT_TRUE(goes(tet, passing, 1.001 * settings_.dwell_s(), advance_mm)) << "tet " << i << ", " << advance_mm << " mm a step";
      EXPECT_FALSE(goes(tet, passing, 0.99 * settings_.dwell_s(), advance_mm)) << "tet " << i << ", " << advance_mm << " mm a step";
    }
  }
  EXPECT_EQ(tested, 4U);
}

}  // namespace
}  // namespace incise
