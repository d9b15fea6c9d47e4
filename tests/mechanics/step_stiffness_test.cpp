#include "mechanics/bodies.hpp"

#include <incise/core/isa.hpp>
#include <incise/mechanics/step_stiffness.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace incise {
namespace {

using testing::clamped_block;
using testing::largest;
using testing::shaken;

constexpr double kStepS = 0.02;
constexpr double kTolerance = 1e-11;  // of the largest entry: what was added and taken away again leaves its rounding

/// A block, clamped at one end, on a platform, and a step that is prepared with it.
class KeptStiffness : public ::testing::TestWithParam<Isa> {
 protected:
  KeptStiffness()
      : model_(make_tissue_model(make_block(Vec3(20, 12, 9), {6, 5, 4}), {},
                                 {FixedConstraint{testing::plane_x(0.0)}, SupportConstraint{}})),
        state_(rest_state(model_)),
        stiffness_(model_) {}
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << "this machine lacks " << to_string(GetParam());
    set_isa(GetParam());
    for (Vec3& p : state_.positions) p.z() -= 0.01;  // into the platform
  }
  void TearDown() override { set_isa(best_isa()); }

  Points prepare(bool is_fresh, int threads = 1) {
    Workers workers(threads);
    Points forces(model_.mesh.vertices.size(), Vec3::Zero());
    stiffness_.begin(model_, state_, kStepS, is_fresh, Tangent::FrozenRotations, forces, workers);
    stiffness_.hold(model_, forces, {}, workers);
    return forces;
  }
  /// The same from nothing.
  BlockMatrix expected(Points& forces) {
    Workers workers(1);
    BlockMatrix matrix(model_.pattern);
    forces.assign(model_.mesh.vertices.size(), Vec3::Zero());
    TissueState state = state_;
    add_elastic_response(model_, state, forces, &matrix, workers);
    add_support_response(model_, state, forces, &matrix);
    for (std::size_t v = 0; v < forces.size(); ++v) {
      for (const int i : {0, 4, 8})
        matrix.block(model_.pattern->diagonal[v])[i] += model_.vertex_mass_kg[v] / (kStepS * kStepS);
    }
    hold_constrained(model_, matrix, forces);
    return matrix;
  }
  void expect_matrix_of_now() {
    Points forces;
    const BlockMatrix whole = expected(forces);
    double scale = 0.0;
    for (const double value : whole.values) scale = std::max(scale, std::abs(value));
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
      ASSERT_NEAR(stiffness_.matrix().values[i], whole.values[i], kTolerance * scale) << "entry " << i;
    }
  }
  /// Turns far and deforms what lies beyond x; lifts it off the platform.
  void move_beyond(double x) {
    const TissueState moved = shaken(model_, 0.6, 5);
    for (std::size_t v = 0; v < state_.positions.size(); ++v) {
      if (model_.mesh.vertices[v].x() > x) state_.positions[v] = moved.positions[v] + Vec3(0, 0, 2);
    }
  }

  TissueModel model_;
  TissueState state_;
  StepStiffness stiffness_;
};

TEST_P(KeptStiffness, IsThatOfAllTetsAfterSomeTurned) {
  prepare(true);
  move_beyond(11.0);
  prepare(false);
  expect_matrix_of_now();
}

TEST_P(KeptStiffness, IsThatOfWhatIsLeftOfTets) {
  prepare(true);
  state_.fill.assign(state_.is_live.size(), 1.0);
  for (std::size_t t = 0; t < state_.fill.size(); t += 3) state_.fill[t] = 0.37;
  prepare(false);
  expect_matrix_of_now();
  move_beyond(11.0);
  for (std::size_t t = 0; t < state_.fill.size(); t += 2) state_.fill[t] = 1e-3;
  prepare(false);
  expect_matrix_of_now();
}

TEST_P(KeptStiffness, IsThatOfTheLiveTetsAfterSomeWereCarved) {
  prepare(true);
  for (std::size_t t = 0; t < state_.is_live.size(); t += 4) state_.is_live[t] = 0;
  prepare(false);
  expect_matrix_of_now();
}

TEST_P(KeptStiffness, StaysRightThroughManySteps) {
  prepare(true);
  for (int step = 0; step < 5; ++step) {
    move_beyond(15.0 - 2.0 * step);
    state_.is_live[static_cast<std::size_t>(17 * step)] = 0;
    prepare(false);
  }
  expect_matrix_of_now();
}

TEST_P(KeptStiffness, GivesTheForcesOfEveryTet) {
  prepare(true);
  for (Vec3& p : state_.positions) p.x() *= 1.001;  // hardly any tet turns
  Points forces;
  expected(forces);
  EXPECT_EQ(prepare(false), forces);
}

TEST_P(KeptStiffness, TakesBackWhatWasAddedForOneStep) {
  prepare(true);
  prepare(false);
  const std::vector<double> before = stiffness_.matrix().values;
  stiffness_.lend(model_, TetId(40));
  for (const std::int32_t slot : model_.tet_slots[40]) stiffness_.matrix().block(slot)[4] += 3.0;
  EXPECT_NE(stiffness_.matrix().values, before);
  prepare(false);
  EXPECT_EQ(stiffness_.matrix().values, before);
}

TEST_P(KeptStiffness, NamesEveryRowThatChanged) {
  prepare(true);
  prepare(false);
  const std::vector<double> before = stiffness_.matrix().values;
  move_beyond(14.0);
  prepare(false);
  std::size_t same = 0;
  for (std::size_t row = 0; row < model_.pattern->rows(); ++row) {
    if (stiffness_.changed_rows()[row] != 0) continue;
    ++same;
    const auto begin = 9 * model_.pattern->row_start[row];
    const auto end = 9 * model_.pattern->row_start[row + 1];
    ASSERT_TRUE(std::equal(before.begin() + begin, before.begin() + end, stiffness_.matrix().values.begin() + begin))
        << row;
  }
  EXPECT_GT(same, model_.pattern->rows() / 3);
}

TEST_P(KeptStiffness, GivesTheSameBitsAtAnyThreadCount) {
  const auto values = [&](int threads) {
    state_ = rest_state(model_);
    prepare(true, threads);
    move_beyond(8.0);
    prepare(false, threads);
    return stiffness_.matrix().values;
  };
  const std::vector<double> one = values(1);
  EXPECT_EQ(values(3), one);
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, KeptStiffness, ::testing::Values(Isa::Portable, Isa::Avx2, Isa::Avx512),
                         [](const auto& which) { return std::string(to_string(which.param)); });

/// Tissue of another law has no kept part: each step gives the matrix of that step.
TEST(StepStiffness, AssemblesOtherLawsAnewInEachStep) {
  Material material{.model = MaterialModel::StableNeoHookean};
  const TissueModel model =
      make_tissue_model(make_block(Vec3(20, 12, 9), {4, 3, 2}), material, {FixedConstraint{testing::plane_x(0.0)}});
  TissueState state = rest_state(model);
  Workers workers(1);
  StepStiffness kept(model);
  StepStiffness fresh(model);
  Points forces(model.mesh.vertices.size(), Vec3::Zero());
  kept.begin(model, state, kStepS, true, Tangent::FrozenRotations, forces, workers);
  for (Vec3& p : state.positions) p.x() *= 1.0005;
  kept.begin(model, state, kStepS, false, Tangent::FrozenRotations, forces, workers);
  fresh.begin(model, state, kStepS, true, Tangent::FrozenRotations, forces, workers);
  EXPECT_EQ(kept.matrix().values, fresh.matrix().values);
}

/// Of viscous tissue, steps that take time have the elastic and the viscous response, others the elastic one alone.
TEST(StepStiffness, AddsTheViscousResponseInAStepThatTakesTime) {
  Material material{.prony = {{1.5, 0.3}}, .kelvin_voigt_time_s = 0.01};
  const TissueModel model =
      make_tissue_model(make_block(Vec3(20, 12, 9), {6, 5, 4}), material, {FixedConstraint{testing::plane_x(0.0)}});
  TissueState state = shaken(model, 0.3, 3);
  remember_deformation(model, state, 0.1);
  StepStiffness stiffness(model);
  Workers workers(1);
  for (const std::optional<double>& viscous_s : {std::optional(0.05), std::optional<double>(), std::optional(0.2)}) {
    for (Vec3& place : state.positions) place.y() *= 1.05;
    TissueState copy = state;
    Points forces(model.mesh.vertices.size(), Vec3::Zero()), expected = forces;
    stiffness.begin(model, state, kStepS, false, Tangent::FrozenRotations, forces, workers, viscous_s);
    BlockMatrix whole(model.pattern);
    add_elastic_response(model, copy, expected, &whole, workers);
    if (viscous_s) add_viscous_response(model, copy, *viscous_s, expected, &whole, workers);
    double scale = 0.0, worst = 0.0;
    for (const double value : whole.values) scale = std::max(scale, std::abs(value));
    for (std::size_t v = 0; v < expected.size(); ++v) {
      EXPECT_LT((forces[v] - expected[v]).norm(), 1e-9 * scale);
      for (const int i : {0, 4, 8})
        whole.block(model.pattern->diagonal[v])[i] += model.vertex_mass_kg[v] / (kStepS * kStepS);
    }
    for (std::size_t i = 0; i < whole.values.size(); ++i)
      worst = std::max(worst, std::abs(whole.values[i] - stiffness.matrix().values[i]));
    EXPECT_LT(worst, 1e-9 * scale) << viscous_s.value_or(0.0);
  }
}

}  // namespace
}  // namespace incise
