#include "point_rule.hpp"

#include "cutting/ring_in_a_block.hpp"
#include "cutting/same_incision.hpp"
#include "point_kerf.hpp"

#include <incise/cutting/cut_invariants.hpp>
#include <incise/cutting/incision_progress.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace incise {
namespace {

using testing::expect_same;

const std::vector<Constraint> kHeldBelow{FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(50, 50, 0.1))}}};
const std::vector<Constraint> kHeldWhole{FixedConstraint{SphereRegion{Vec3::Zero(), 1e3}}};

TEST(PointLattice, StandsForTheVolumeOfEachTetWithNodesThatLieInIt) {
  for (const int cells : {2, 24}) {  // tets of many nodes, and of fewer than four
    const TissueModel model = make_tissue_model(make_block({6, 6, 6}, {cells, cells, cells}), Material{}, kHeldBelow);
    PointLattice lattice(model, {});
    for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) lattice.add(TetId(t));
    std::set<PointLattice::Node> nodes;
    std::size_t of_nodes = 0;
    for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
      const auto [first, last] = lattice.points_of(TetId(t));
      double volume = 0.0;
      for (std::size_t i = first; i < last; ++i) {
        volume += lattice.volume_mm3(i);
        for (const double share : lattice.shares(i)) ASSERT_GE(share, 0.0);
        if (!lattice.node_of(i)) continue;
        nodes.insert(*lattice.node_of(i));
        ++of_nodes;
        EXPECT_NEAR(
            (lattice.position(i, model.mesh.vertices) - PointLattice::rest_position(*lattice.node_of(i))).norm(), 0.0,
            1e-9);
      }
      ASSERT_NEAR(volume, model.volumes_mm3[t], 1e-12);
    }
    EXPECT_EQ(of_nodes, nodes.size()) << "each node in one tet";
    EXPECT_EQ(nodes.size(), 27000U) << "of a body of 216 mm³";
  }
}

/// A straight pass along y at x = 6 through a block, deep enough that the tip's end does not matter half-way down.
class StraightPass : public ::testing::Test {
 protected:
  StraightPass() { settings_.rule = CutRule::Lattice; }

  ToolPose at(double y) const { return {Vec3(6.0, y, 1.0), -Vec3::UnitZ(), Vec3::UnitY()}; }

  void pass(const TissueModel& model, double from, double to, int threads = 2) {
    Workers workers(threads);
    CutWorkspace workspace(model, model.mesh.vertices);
    state_ = begin_cut(model, rest_state(model), at(from));
    const double step_mm = settings_.advance_per_step_mm;
    for (double y = from + step_mm; y < to; y += step_mm) {
      reports_.push_back(
          advance(model, settings_, Needle{}, state_, workspace, at(y), step_mm / settings_.speed_mm_s, workers));
      EXPECT_THAT(cut_invariants(model, state_), ::testing::IsEmpty());
    }
  }

  /// Of the kerf in tissue that cannot move: at a distance y beside the way, the dose is
  /// (ℓ / (v d τ0)) (1 − y²/R²)^(5/2).
  [[nodiscard]] double half_width_mm() const {
    const double on_the_way = settings_.dose_length_mm / (settings_.speed_mm_s * settings_.dwell_s());
    return settings_.kernel_radius_mm * std::sqrt(1.0 - std::pow(on_the_way, -0.4));
  }
  /// Within 1 mm of a place along the pass.
  [[nodiscard]] static Box3 part_of(const TriMesh& surface, double y) {
    Box3 box;
    for (const Vec3& v : surface.vertices) {
      if (std::abs(v.y() - y) < 1.0) box.extend(v);
    }
    return box;
  }

  CutSettings settings_;
  CutState state_;
  std::vector<CutStepReport> reports_;
};

TEST_F(StraightPass, ThroughTissueThatCannotMoveLeavesTheKerfOfItsKernel) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {12, 12, 6}), Material{}, kHeldWhole);
  settings_.dullness = 5.0;
  settings_.advance_per_step_mm = 0.13;
  pass(model, 1.0, 11.0);
  const PointKerf kerf(model, state_.points, model.mesh.vertices);
  double volume = 0.0;
  for (const auto& [a, b, c, d] : kerf.tets()) volume += std::abs(signed_volume(a, b, c, d));
  const TriMesh surface = kerf.surface();
  EXPECT_NEAR(enclosed_volume_mm3(surface), volume, 0.03 * volume);
  const Box3 box = part_of(surface, 6.0);
  EXPECT_NEAR(box.sizes().x(), 2.0 * half_width_mm(), 0.03);
  EXPECT_NEAR(box.center().x(), 6.0, 0.005);
  EXPECT_EQ(state_.record.removals.size(), 0U)
      << "no tet of 1 mm is empty: the kerf is " << 2.0 * half_width_mm() << " mm wide";
}

TEST_F(StraightPass, ThroughFineTetsEmptiesAndRemovesThoseInTheMiddleOfTheSameKerf) {
  const TissueModel model = make_tissue_model(make_block({8, 8, 4}, {20, 20, 10}), Material{}, kHeldWhole);
  settings_.dullness = 5.0;
  settings_.advance_per_step_mm = 0.13;
  pass(model, 1.0, 7.0);
  const Box3 box = part_of(PointKerf(model, state_.points, model.mesh.vertices).surface(), 4.0);
  EXPECT_NEAR(box.sizes().x(), 2.0 * half_width_mm(), 0.03);
  ASSERT_GT(state_.record.removals.size(), 20U);
  for (const Removal& removal : state_.record.removals)
    EXPECT_LT(std::abs(removal.centroid_mm.x() - 6.0), half_width_mm() + 0.01) << "in the kerf";
}

TEST_F(StraightPass, AWorkspaceMayBeTakenBackToAnEarlierState) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldBelow);
  Workers workers(1);
  CutWorkspace workspace(model, model.mesh.vertices), fresh(model, model.mesh.vertices);
  CutState early = begin_cut(model, rest_state(model), at(1.0));
  CutState late = early;
  for (int i = 1; i <= 12; ++i)
    static_cast<void>(advance(model, settings_, Needle{}, late, workspace, at(1.0 + 0.5 * i), 0.02, workers));
  CutState alone = early;
  static_cast<void>(advance(model, settings_, Needle{}, early, workspace, at(1.26), 0.02, workers));
  static_cast<void>(advance(model, settings_, Needle{}, alone, fresh, at(1.26), 0.02, workers));
  EXPECT_THAT(cut_invariants(model, early), ::testing::IsEmpty());
  EXPECT_EQ(early.points.dose, alone.points.dose);
}

TEST_F(StraightPass, PullsNoHarderThanItsSlipWhateverTheStep) {
  const TissueModel model =
      make_tissue_model(make_block({12, 16, 6}, {12, 16, 6}), {.youngs_modulus_kpa = 12.0}, kHeldBelow);
  settings_.slip_mn_mm = 15.0;
  settings_.residual_tolerance = 1e-3;
  std::vector<double> steady;
  for (const double step_mm : {0.13, 0.26, 0.52}) {
    settings_.advance_per_step_mm = step_mm;
    reports_.clear();
    pass(model, 1.0, 12.0);
    double sum = 0.0;
    const std::size_t half = reports_.size() / 2;
    for (std::size_t i = half; i < reports_.size(); ++i) sum += reports_[i].tool_force_mn.norm();
    steady.push_back(sum / static_cast<double>(reports_.size() - half));
    EXPECT_GT(reports_.back().slipped, 0U);
    // Six millimetres of tissue above the tip, of which hats reach half a millimetre beyond.
    EXPECT_LE(reports_.back().tool_force_mn.norm(), 15.0 * 5.5 * 1.001);
  }
  EXPECT_NEAR(steady[0], steady[1], 0.03 * steady[1]);
  EXPECT_NEAR(steady[2], steady[1], 0.06 * steady[1]);
}

TEST_F(StraightPass, WithoutSlipPullsHarder) {
  const TissueModel model =
      make_tissue_model(make_block({12, 16, 6}, {12, 16, 6}), {.youngs_modulus_kpa = 12.0}, kHeldBelow);
  settings_.slip_mn_mm.reset();
  pass(model, 1.0, 6.0);
  EXPECT_GT(reports_.back().tool_force_mn.norm(), 15.0 * 5.5 * 1.5);
  EXPECT_LT(reports_.back().tool_force_mn.y(), 0.0) << "the tissue pulls the tool back";
  EXPECT_EQ(reports_.back().slipped, 0U);
}

TEST_F(StraightPass, TissueTwiceAsToughTakesTwiceTheDose) {
  TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldWhole);
  pass(model, 1.0, 11.0);
  const std::vector<double> soft = state_.points.dose;
  model.toughness.assign(model.mesh.tets.size(), 2.0);
  pass(model, 1.0, 11.0);
  ASSERT_EQ(state_.points.dose.size(), soft.size());
  for (std::size_t i = 0; i < soft.size(); ++i) ASSERT_NEAR(state_.points.dose[i], 0.5 * soft[i], 1e-12);
}

TEST_F(StraightPass, InvariantsFindPointsThatCannotBe) {
  const TissueModel model = make_tissue_model(make_block({12, 12, 6}, {6, 6, 3}), Material{}, kHeldBelow);
  pass(model, 1.0, 4.0);
  const CutState sound = state_;
  state_.points.dose[3] = -0.1;
  EXPECT_EQ(cut_invariants(model, state_).size(), 1U);
  state_ = sound;
  state_.tissue.fill[state_.points.tets.front().index()] = 1.5;
  EXPECT_EQ(cut_invariants(model, state_).size(), 1U);
  state_ = sound;
  state_.points.dose.pop_back();
  EXPECT_EQ(cut_invariants(model, state_).size(), 1U);
}

TEST_F(StraightPass, SettingsOfTheOtherRuleAreRefused) {
  settings_.tear_energy_kpa = 10.0;
  settings_.slip_mm = 1.0;
  EXPECT_EQ(validate(settings_, 1.0).size(), 2U);
  settings_.rule = CutRule::Tets;
  EXPECT_TRUE(validate(settings_, 1.0).empty());
}

class RingByPoints : public testing::RingInABlock {
 protected:
  RingByPoints() : RingInABlock(16) {
    settings_.tool = Needle{};
    settings_.cut.rule = CutRule::Lattice;
    settings_.cut.advance_per_step_mm = 0.5;
  }
  [[nodiscard]] IncisionResult carry_on(IncisionProgress progress, int threads, Monitor& monitor,
                                        const ProgressKeeper& keep = {}) const {
    Workers workers(threads);
    return continue_incision(model_, rest_state(model_), ring(4.0), settings_, std::move(progress), workers, monitor,
                             keep);
  }
  [[nodiscard]] IncisionProgress begin() const {
    return begin_incision(model_, rest_state(model_), ring(4.0), settings_);
  }
};

TEST_F(RingByPoints, ClosesAndHasTheSameBitsAtAnyThreadCountAndFromACheckpoint) {
  Monitor silent;
  const IncisionResult straight = carry_on(begin(), 1, silent);
  EXPECT_EQ(straight.outcome, Outcome::Success);
  ASSERT_TRUE(straight.centerline.has_value());
  EXPECT_NEAR(mean_radius(*straight.centerline), kRadiusMm, 0.5);
  EXPECT_GT(straight.kerf.drag.value().lag.mean, 0.0);
  EXPECT_FALSE(straight.inner_edge.has_value());
  expect_same(straight, carry_on(begin(), 3, silent), "three threads");
  StopAtHalf half;
  std::optional<IncisionProgress> kept;
  static_cast<void>(carry_on(begin(), 2, half, [&](const IncisionProgress& progress, bool is_interrupted) {
    if (is_interrupted) kept = progress;
  }));
  ASSERT_TRUE(kept.has_value());
  const IncisionResult resumed = carry_on(*kept, 2, silent);
  expect_same(straight, resumed, "from a checkpoint");
  EXPECT_EQ(straight.final_state.points.dose, resumed.final_state.points.dose);
}

}  // namespace
}  // namespace incise
