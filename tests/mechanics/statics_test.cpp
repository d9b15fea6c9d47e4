#include "mechanics/bodies.hpp"
#include "support/monitors.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/statics.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using testing::largest;
using testing::plane_x;
using testing::plane_z;
using testing::solve;

/// The paper's specimen as a block: one end clamped, the other pulled, the underside on a platform.
TissueModel pulled_block(double pull_mm, std::array<int, 3> cells = {10, 5, 4}, const Vec3& gravity = Vec3::Zero()) {
  return make_tissue_model(make_block(Vec3(100, 50, 25), cells), {},
                           {FixedConstraint{plane_x(0.0)}, DisplacedConstraint{plane_x(100.0), Vec3(pull_mm, 0, 0)},
                            SupportConstraint{Vec3::Zero(), Vec3::UnitZ()}},
                           gravity);
}

TEST(SolveStatic, StretchesBy20MmFromRestInOneLoadStep) {
  const StaticResult result = solve(pulled_block(20.0));
  EXPECT_EQ(result.outcome, Outcome::Success);
  EXPECT_EQ(result.load_steps, 1);
  EXPECT_LE(result.iterations, 8)
      << "a few steps find which vertices rest on the platform, then the exact tangent converges quadratically";
  EXPECT_LE(result.relative_residual, 1e-6);
  EXPECT_EQ(result.inverted_tets, 0U);
  EXPECT_GE(result.max_displacement_mm, 20.0);
}

TEST(SolveStatic, ConvergesQuadraticallyNearTheSolution) {
  StaticSettings settings{.relative_tolerance = 1e-10};
  const StaticResult result = solve(pulled_block(20.0), settings);
  ASSERT_EQ(result.outcome, Outcome::Success);
  const auto& history = result.residual_history;
  ASSERT_GE(history.size(), 3U);
  EXPECT_LT(history.back(), 0.01 * history[history.size() - 2]);
}

TEST(SolveStatic, ReactionsBalanceTheLoads) {
  const TissueModel model = pulled_block(10.0, {10, 5, 4}, Vec3(0, 0, -9810));
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& reaction : result.reactions_mn) sum += reaction;
  for (const Vec3& load : model.dead_load_mn) sum += load;
  EXPECT_LT(sum.norm(), 1e-5 * result.reactions_mn[0].norm());
  EXPECT_GT(result.reactions_mn[1][0], 0.0) << "the end is pulled towards +x";
}

TEST(SolveStatic, SupportCarriesTheBodyWithoutPenetration) {
  const TissueModel model = pulled_block(0.0, {10, 5, 4}, Vec3(0, 0, -9810));
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  EXPECT_GT(result.reactions_mn[2][2], 100.0);
  EXPECT_LT(result.reactions_mn[2].head<2>().norm(), 1e-9) << "frictionless";
  EXPECT_GT(result.penetration_mm, 0.0);
  EXPECT_LT(result.penetration_mm, 0.05);
}

TEST(SolveStatic, SupportHoldsAgainstAFirmPress) {
  const TissueModel model =
      make_tissue_model(make_block(Vec3(40, 40, 20), {6, 6, 4}), {},
                        {FixedConstraint{plane_x(0.0)}, SupportConstraint{Vec3::Zero(), Vec3::UnitZ()},
                         TractionConstraint{plane_z(20.0), Vec3(0, 0, -10)}});
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  EXPECT_LT(result.penetration_mm, 0.05);
  EXPECT_GT(result.reactions_mn[1][2], 0.5 * 10.0 * 1600.0);
}

/// A column on a plane between walls, its lowest layer of tets of the given modulus, pressed down by 0.8 mm.
TissueModel layered_column(double bottom_kpa) {
  const TetMesh mesh = make_block(Vec3(10, 10, 20), {1, 1, 4});
  MaterialField field;
  for (const Tet& tet : mesh.tets) {
    double height = 0.0;
    for (const VertexId v : tet) height += 0.25 * mesh.vertices[v.index()][2];
    field.youngs_modulus_kpa.push_back(height < 5.0 ? bottom_kpa : 70.0);
  }
  return make_tissue_model(mesh, {},
                           {DisplacedConstraint{plane_z(20.0), Vec3(0, 0, -0.8)},
                            FixedConstraint{plane_x(0.0), {true, false, false}},
                            SupportConstraint{Vec3::Zero(), Vec3::UnitZ()},
                            FixedConstraint{plane_x(10.0), {true, false, false}},
                            FixedConstraint{testing::plane_y(0.0), {false, true, false}},
                            FixedConstraint{testing::plane_y(10.0), {false, true, false}}},
                           Vec3::Zero(), field);
}

TEST(SolveStatic, WarnsOfTissueThatSinksIntoASupport) {
  Workers workers(1);
  testing::RecordingMonitor soft;
  const StaticResult sunk = solve_static(layered_column(6.0), {}, workers, soft);
  ASSERT_EQ(sunk.outcome, Outcome::Success);
  EXPECT_GT(sunk.penetration_mm, 0.05);
  ASSERT_EQ(soft.warnings.size(), 1U);
  EXPECT_THAT(soft.warnings[0],
              ::testing::AllOf(::testing::HasSubstr("specimen.constraints[2]"),
                               ::testing::HasSubstr(fmt::format("up to {:.3g} mm", sunk.penetration_mm))));
  testing::RecordingMonitor firm;
  EXPECT_LT(solve_static(layered_column(70.0), {}, workers, firm).penetration_mm, 0.05);
  EXPECT_THAT(firm.warnings, ::testing::IsEmpty());
}

TEST(SolveStatic, ALoadWhoseResidualCannotBeMeasuredIsNotConvergedWithoutAResidual) {
  const StaticResult result =
      solve(make_tissue_model(make_block(Vec3(10, 10, 10), {2, 2, 2}), {},
                              {FixedConstraint{plane_x(0.0)}, TractionConstraint{plane_x(10.0), Vec3(1e200, 0, 0)}}));
  EXPECT_EQ(result.outcome, Outcome::NotConverged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_TRUE(std::isnan(result.relative_residual)) << result.relative_residual;
}

TEST(SolveStatic, SupportLetsTissueLiftOff) {
  const TissueModel model =
      make_tissue_model(make_block(Vec3(40, 20, 20), {6, 3, 3}), {},
                        {FixedConstraint{plane_x(0.0)}, SupportConstraint{Vec3::Zero(), Vec3::UnitZ()},
                         TractionConstraint{plane_x(40.0), Vec3(0, 0, 0.5)}});
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  EXPECT_GE(result.reactions_mn[1][2], 0.0) << "a support never pulls";
  EXPECT_LT(result.reactions_mn[1][2], 0.2 * result.reactions_mn[2][2]);
  EXPECT_GT(result.state.positions.back()[2], 20.1);
}

TEST(SolveStatic, AnUnloadedBodyStaysAtRest) {
  const TissueModel model = pulled_block(0.0);
  const StaticResult result = solve(model);
  EXPECT_EQ(result.outcome, Outcome::Success);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.state.positions, model.mesh.vertices);
}

TEST(SolveStatic, SmallerLoadStepsEndInTheSamePlace) {
  const TissueModel model = pulled_block(20.0, {10, 5, 4}, Vec3(0, 0, -9810));
  StaticSettings small{.first_load_fraction = 0.25};
  const StaticResult one = solve(model);
  const StaticResult many = solve(model, small);
  ASSERT_EQ(many.outcome, Outcome::Success);
  EXPECT_GT(many.load_steps, one.load_steps);
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    ASSERT_LT((one.state.positions[v] - many.state.positions[v]).norm(), 1e-4);
  }
}

TEST(SolveStatic, ContinuesFromAGivenState) {
  const StaticResult first = solve(pulled_block(10.0));
  const StaticResult second = solve(pulled_block(20.0), {}, 1, &first.state);
  const StaticResult direct = solve(pulled_block(20.0));
  ASSERT_EQ(second.outcome, Outcome::Success);
  for (std::size_t v = 0; v < direct.state.positions.size(); ++v) {
    ASSERT_LT((second.state.positions[v] - direct.state.positions[v]).norm(), 1e-4);
  }
}

TEST(SolveStatic, GivesTheSameBitsAtAnyThreadCount) {
  const TissueModel model = pulled_block(20.0, {12, 7, 5});
  const StaticResult one = solve(model, {}, 1);
  EXPECT_EQ(solve(model, {}, 2).state.positions, one.state.positions);
  EXPECT_EQ(solve(model, {}, 4).state.positions, one.state.positions);
}

TEST(SolveStatic, ConjugateGradientsEndInTheSamePlaceAsCholesky) {
  const TissueModel model = pulled_block(20.0, {10, 5, 4}, Vec3(0, 0, -9810));
  StaticSettings settings{.relative_tolerance = 1e-8, .solver = LinearSolver::Cholesky};
  const StaticResult direct = solve(model, settings);
  settings.solver = LinearSolver::ConjugateGradients;
  const StaticResult iterated = solve(model, settings);
  ASSERT_EQ(iterated.outcome, Outcome::Success);
  EXPECT_LE(iterated.relative_residual, 1e-8);
  EXPECT_GT(iterated.linear_iterations, 0);
  EXPECT_EQ(direct.linear_iterations, 0);
  EXPECT_LE(iterated.iterations, direct.iterations + 4) << "inexact steps cost a few more";
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    ASSERT_LT((iterated.state.positions[v] - direct.state.positions[v]).norm(), 1e-5);
  }
}

TEST(SolveStatic, ChoosesTheSolverByTheSizeOfTheBodyAndSaysSo) {
  const StaticResult small = solve(pulled_block(20.0));
  EXPECT_NE(small.solver.find("sparse Cholesky"), std::string::npos) << small.solver;
  const StaticResult large = solve(pulled_block(5.0, {30, 15, 8}));
  ASSERT_EQ(large.outcome, Outcome::Success);
  EXPECT_NE(large.solver.find("conjugate gradients"), std::string::npos) << large.solver;
}

TEST(SolveStatic, ConjugateGradientsGiveTheSameBitsAtAnyThreadCount) {
  const TissueModel model = pulled_block(20.0, {12, 7, 5});
  StaticSettings settings{.solver = LinearSolver::ConjugateGradients};
  const StaticResult one = solve(model, settings, 1);
  EXPECT_EQ(solve(model, settings, 2).state.positions, one.state.positions);
}

TEST(SolveStatic, ReportsEveryIterationAndNeverTakesProgressBack) {
  testing::RecordingMonitor listener;
  Workers workers(1);
  StaticSettings settings{.first_load_fraction = 0.5};
  const StaticResult result = solve_static(pulled_block(20.0), settings, workers, listener);
  ASSERT_EQ(result.outcome, Outcome::Success);
  EXPECT_EQ(listener.messages.size(), result.residual_history.size());
  EXPECT_TRUE(std::is_sorted(listener.fractions.begin(), listener.fractions.end()));
  EXPECT_EQ(listener.fractions.back(), 1.0);
}

TEST(SolveStatic, SaysWhenItDidNotConverge) {
  StaticSettings settings{.max_newton_iterations = 2};
  const StaticResult result = solve(pulled_block(20.0), settings);
  EXPECT_EQ(result.outcome, Outcome::NotConverged);
  EXPECT_EQ(result.iterations, 2);
}

TEST(SolveStatic, SaysWhenTetsWereTurnedInsideOut) {
  // A cube whose end is pushed through the clamp.
  const TissueModel model =
      make_tissue_model(make_block(Vec3(10, 10, 10), {2, 2, 2}), {},
                        {FixedConstraint{plane_x(0.0)}, DisplacedConstraint{plane_x(10.0), Vec3(-14, 0, 0)}});
  const StaticResult result = solve(model);
  EXPECT_NE(result.outcome, Outcome::Success);
  EXPECT_GT(result.inverted_tets, 0U);
  for (const Vec3& p : result.state.positions) EXPECT_TRUE(p.allFinite());
}

TEST(SolveStatic, StopsWhenAsked) {
  testing::StopAfter monitor;
  Workers workers(1);
  EXPECT_EQ(solve_static(pulled_block(20.0), {}, workers, monitor).outcome, Outcome::Cancelled);
}

TEST(SolveStatic, RefusesSettingsOutOfRange) {
  StaticSettings settings{.first_load_fraction = 0.0};
  EXPECT_THROW(solve(pulled_block(1.0), settings), InvalidArgument);
  settings = {};
  settings.relative_tolerance = -1.0;
  EXPECT_THROW(solve(pulled_block(1.0), settings), InvalidArgument);
}

TEST(VonMises, IsTheStressOfAUniaxialPull) {
  Material material{.poissons_ratio = 0.3};
  const TissueModel model = make_tissue_model(
      make_block(Vec3(20, 10, 10), {4, 2, 2}), material,
      {FixedConstraint{plane_x(0.0), {true, false, false}},
       FixedConstraint{testing::plane_y(0.0), {false, true, false}},
       FixedConstraint{plane_z(0.0), {false, false, true}}, TractionConstraint{plane_x(20.0), Vec3(7, 0, 0)}});
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  EXPECT_THAT(von_mises_kpa(model, result.state), ::testing::Each(::testing::DoubleNear(7.0, 1e-4)));
}

}  // namespace
}  // namespace incise
