#include <incise/cutting/carving.hpp>
#include <incise/cutting/tool_program.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
  CutSettings settings;
  settings.bond_stiffness_kpa_mm2 = 0.0;
  EXPECT_EQ(removed(run(settings, 10.3, 10.3, 9, 0.02)), removed(run(settings, 10.3, 10.3, 36, 0.005)));
}

TEST_F(Carve, EveryTetThatIsRemovedWasWithinReachOfTheNeedle) {
  CutSettings settings;
  settings.bond_stiffness_kpa_mm2 = 0.0;
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

/// At every twentieth step nothing is used that the state does not hold: a new workspace goes on as the old one does.
TEST_F(Carve, GoesOnFromATwentiethStepWithTheSameBits) {
  const CutSettings settings;
  Workers workers(1);
  const auto go = [&](CutState& state, CutWorkspace& workspace, int from, int to) {
    for (int i = from + 1; i <= to; ++i) {
      static_cast<void>(advance(model_, settings, needle_, state, workspace, standing_at(5.0 + 0.2 * i), 0.02, workers));
    }
  };
  CutState whole = begin_cut(model_, rest_state(model_), standing_at(5.0));
  CutWorkspace workspace(model_, whole.tissue.positions);
  go(whole, workspace, 0, 20);
  CutState later = whole;
  go(whole, workspace, 20, 33);
  CutWorkspace another(model_, model_.mesh.vertices);
  go(later, another, 20, 33);
  EXPECT_FALSE(removed(whole).empty());
  EXPECT_EQ(removed(later), removed(whole));
  EXPECT_EQ(later.tissue.positions, whole.tissue.positions);
  EXPECT_EQ(later.tissue.rotations, whole.tissue.rotations);
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
  CutSettings settings;
  settings.bond_stiffness_kpa_mm2 = 0.0;
  settings.dullness = 1000.0;
  const CutState state = run(settings, 10.0, 10.8, 5, 0.02);
  EXPECT_EQ(state.tissue.positions, model_.mesh.vertices);
}

TEST_F(Carve, TissueReturnsWhenTheToolIsOut) {
  CutSettings settings;
  settings.dullness = 1000.0;
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

}  // namespace
}  // namespace incise
