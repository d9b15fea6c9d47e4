#include "contact.hpp"
#include "cutting/ring_in_a_block.hpp"

#include <incise/cutting/carving.hpp>
#include <incise/cutting/cut_invariants.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace incise {
namespace {

using ::testing::IsEmpty;

/// A 20 x 10 x 8 mm block with cells of 1 mm, held at its underside; the needle has its tip in the block's middle. The
/// tool drags nothing unless a test says so.
class PaperRule : public ::testing::Test {
 protected:
  static constexpr double kHereX = 10.3;

  PaperRule()
      : model_(make_tissue_model(make_block({20, 10, 8}, {20, 10, 8}), Material{},
                                 {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(21, 11, 0.1))}}})) {
    settings_.rule = CutRule::Paper;
    settings_.dullness = 4.0;
    settings_.bond_stiffness_kpa_mm2 = 0.0;
  }

  static ToolPose standing_at(double x) { return {Vec3(x, 5.2, 4.0), -Vec3::UnitZ()}; }

  /// Goes from place to place, a step each. @param visit  is given the state before and after each step.
  template <class Visit>
  CutState follow(const std::vector<double>& places, const Visit& visit, double step_s = 0.02, int threads = 1) {
    Workers workers(threads);
    CutState state = begin_cut(model_, rest_state(model_), standing_at(places.front()));
    CutWorkspace workspace(model_, state.tissue.positions);
    for (std::size_t i = 1; i < places.size(); ++i) {
      const CutState before = state;
      const ToolPose next = standing_at(places[i]);
      EXPECT_TRUE(advance(model_, settings_, needle_, state, workspace, next, step_s, workers).is_finite);
      EXPECT_THAT(cut_invariants(model_, state), IsEmpty());
      visit(before, state);
    }
    return state;
  }
  CutState follow(const std::vector<double>& places, double step_s = 0.02, int threads = 1) {
    return follow(
        places, [](const CutState&, const CutState&) {}, step_s, threads);
  }

  /// A place for the beginning and for the end of each step.
  static std::vector<double> stay(int steps) {
    return std::vector<double>(static_cast<std::size_t>(steps) + 1, kHereX);
  }

  static std::vector<double> way(double from, double to, int steps) {
    std::vector<double> places;
    for (int i = 0; i <= steps; ++i) places.push_back(from + (to - from) * i / steps);
    return places;
  }

  [[nodiscard]] std::set<TetId> at_surface(const CutState& state) const {
    std::set<TetId> tets;
    for (const BoundaryFace& face : boundary_faces(model_.mesh, state.tissue.is_live)) tets.insert(face.tet);
    return tets;
  }

  [[nodiscard]] double distance_from_needle(const CutState& state, TetId tet) const {
    return distance_to_core(corners_of(state.tissue.positions, model_.mesh.tets[tet.index()]),
                            ToolCore(needle_, state.tool));
  }

  TissueModel model_;
  CutSettings settings_;
  Needle needle_;
};

TEST_F(PaperRule, HoldsAndRemovesTheTetsWithinReachThatLieAtTheSurfaceAndNoOthers) {
  std::size_t held = 0, touched_inside = 0, removed = 0;
  settings_.bond_stiffness_kpa_mm2 = 1500.0;
  follow(way(5.0, 11.0, 24), [&](const CutState& before, const CutState& after) {
    const std::set<TetId> surface = at_surface(before);
    const double limit_mm = needle_.radius_mm() + settings_.reach_mm;
    std::set<TetId> expected;
    for (std::size_t t = 0; t < model_.mesh.tets.size(); ++t) {
      const TetId tet(t);
      if (before.tissue.is_live[t] == 0 || distance_from_needle(before, tet) > limit_mm) continue;
      if (surface.contains(tet))
        expected.insert(tet);
      else
        ++touched_inside;
    }
    std::set<TetId> found;
    for (const Bond& bond : after.bonds) found.insert(bond.tet);
    for (std::size_t i = before.record.removals.size(); i < after.record.removals.size(); ++i) {
      const Removal& removal = after.record.removals[i];
      if (removal.cause == RemovalCause::LooseFragment) {
        expected.erase(removal.tet);
        continue;
      }
      found.insert(removal.tet);
      ++removed;
    }
    EXPECT_EQ(found, expected) << "step " << after.step;
    held += found.size();
  });
  EXPECT_GT(held, 100U);
  EXPECT_GT(removed, 20U);
  EXPECT_GT(touched_inside, 100U) << "tets that the needle passes and does not hold";
}

TEST_F(PaperRule, GoesOneLayerDeeperForEachFullCount) {
  const std::set<TetId> uncut = at_surface(begin_cut(model_, rest_state(model_), standing_at(kHereX)));
  const CutState state = follow(stay(8));
  std::set<int> steps_outside, steps_inside;
  for (const Removal& removal : state.record.removals) {
    if (removal.cause == RemovalCause::LooseFragment) continue;
    (uncut.contains(removal.tet) ? steps_outside : steps_inside).insert(removal.step);
  }
  EXPECT_EQ(steps_outside, std::set<int>{4});
  EXPECT_EQ(steps_inside, std::set<int>{8}) << "bared in step 4 and touched from step 5 on";
}

TEST_F(PaperRule, RemovesAfterTheCountOfStepsHoweverLongTheyAre) {
  for (const double step_s : {1e-3, 0.02, 0.5}) {
    EXPECT_THAT(follow(stay(3), step_s).record.removals, IsEmpty()) << step_s << " s a step";
    EXPECT_FALSE(follow(stay(4), step_s).record.removals.empty()) << step_s << " s a step";
  }
  settings_.rule = CutRule::Tets;
  EXPECT_FALSE(follow(stay(3), 0.5).record.removals.empty()) << "time counts by the other rule";
}

TEST_F(PaperRule, ADullnessBetweenTwoCountsTakesTheGreaterAndASharpToolOneStep) {
  settings_.dullness = 2.4;
  EXPECT_THAT(follow(stay(2)).record.removals, IsEmpty());
  EXPECT_FALSE(follow(stay(3)).record.removals.empty());
  settings_.dullness = 1.0;
  EXPECT_FALSE(follow(stay(1)).record.removals.empty());
}

TEST_F(PaperRule, PowerAndToughnessChangeTheCountThatIsNeeded) {
  settings_.power_w = 2.0 * settings_.reference_power_w;
  EXPECT_THAT(follow(stay(1)).record.removals, IsEmpty());
  EXPECT_FALSE(follow(stay(2)).record.removals.empty());
  model_.toughness.assign(model_.mesh.tets.size(), 3.0);
  EXPECT_THAT(follow(stay(5)).record.removals, IsEmpty());
  EXPECT_FALSE(follow(stay(6)).record.removals.empty());
}

TEST_F(PaperRule, AnInterruptedCountIsKeptOrBeginsAnew) {
  constexpr double kAway = kHereX - 5.0;
  // Three steps begin here, one away, and then one more, or four, here.
  const std::vector<double> one_more{kHereX, kHereX, kHereX, kAway, kHereX, kHereX};
  std::vector<double> four_more = one_more;
  four_more.insert(four_more.end(), 3, kHereX);
  EXPECT_FALSE(follow(one_more).record.removals.empty()) << "kept: 3 + 1 steps of 4";
  settings_.contact_count = ContactCount::Reset;
  EXPECT_THAT(follow(one_more).record.removals, IsEmpty()) << "1 step of 4 after the reset";
  four_more.pop_back();
  EXPECT_THAT(follow(four_more).record.removals, IsEmpty());
  four_more.push_back(kHereX);
  EXPECT_FALSE(follow(four_more).record.removals.empty());
}

TEST_F(PaperRule, WithoutAnInterruptionKeepAndResetAreTheSame) {
  const CutState kept = follow(stay(9));
  settings_.contact_count = ContactCount::Reset;
  EXPECT_EQ(follow(stay(9)).tissue.is_live, kept.tissue.is_live);
  EXPECT_GT(kept.record.removals.size(), 10U);
}

TEST_F(PaperRule, GivesTheSameBitsAtAnyThreadCount) {
  settings_.bond_stiffness_kpa_mm2 = 1500.0;
  const std::vector<double> places = way(5.0, 12.0, 35);
  const CutState one = follow(places);
  EXPECT_FALSE(one.record.removals.empty());
  EXPECT_NE(one.tissue.positions, model_.mesh.vertices);
  for (const int threads : {2, 4}) {
    const CutState many = follow(places, 0.02, threads);
    EXPECT_EQ(one.tissue.is_live, many.tissue.is_live) << threads << " threads";
    EXPECT_EQ(one.tissue.positions, many.tissue.positions) << threads << " threads";
    EXPECT_EQ(one.dose, many.dose) << threads << " threads";
  }
}

TEST_F(PaperRule, FromARenewalStepANewWorkspaceGivesTheSameBits) {
  settings_.bond_stiffness_kpa_mm2 = 1500.0;
  settings_.contact_count = ContactCount::Reset;
  const std::vector<double> places = way(5.0, 12.0, 40);
  CutState middle;
  const CutState straight = follow(places, [&](const CutState& before, const CutState&) {
    if (before.step == 20) middle = before;
  });
  ASSERT_TRUE(is_renewal_step(middle));
  ASSERT_FALSE(middle.bonds.empty());
  Workers workers(1);
  CutWorkspace fresh(model_, model_.mesh.vertices);
  for (std::size_t i = 21; i < places.size(); ++i)
    static_cast<void>(advance(model_, settings_, needle_, middle, fresh, standing_at(places[i]), 0.02, workers));
  EXPECT_EQ(middle.tissue.positions, straight.tissue.positions);
  EXPECT_EQ(middle.dose, straight.dose);
}

class PaperRuleRing : public testing::RingInABlock {};

TEST_F(PaperRuleRing, OfASharpToolClosesInStepsOfTheReferenceTime) {
  settings_.cut.rule = CutRule::Paper;
  settings_.cut.dullness = 1.0;
  settings_.cut.reference_step_s = 0.05;
  const IncisionResult result = cut(ring(4.0));
  EXPECT_EQ(result.outcome, Outcome::Success);
  EXPECT_NEAR(result.steps[1].time_s - result.steps[0].time_s, 0.05, 1e-12);
  EXPECT_NEAR(mean_radius(*result.centerline), kRadiusMm, 0.5);
}

}  // namespace
}  // namespace incise
