#include "mechanics/bodies.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/motion.hpp>
#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace incise {
namespace {

using testing::clamped_block;
using testing::norm;
using testing::plane_x;

StepReport step(const TissueModel& model, Motion& motion, const MotionSettings& settings, int count = 1,
                int threads = 1) {
  Workers workers(threads);
  MotionWorkspace workspace(model, settings);
  StepReport report;
  for (int i = 0; i < count; ++i) {
    report = advance_motion(model, motion, settings, workspace, workers);
    EXPECT_EQ(report.outcome, Outcome::Success) << "step " << i;
  }
  return report;
}

/// ½ Σ m v², µJ.
double kinetic_energy_uj(const TissueModel& model, const Motion& motion) {
  double twice = 0.0;
  for (std::size_t v = 0; v < motion.velocities_mm_s.size(); ++v)
    twice += model.vertex_mass_kg[v] * motion.velocities_mm_s[v].squaredNorm();
  return 0.5 * twice;
}

/// A clamped block that hangs in gravity.
TissueModel heavy_block() {
  Material material{.youngs_modulus_kpa = 5.0, .poissons_ratio = 0.4};
  return make_tissue_model(testing::irregular_block(Vec3(20, 12, 9), {4, 3, 3}, 0.2, 7), material,
                           {FixedConstraint{plane_x(0.0)}}, Vec3(0, 0, -9810));
}

TEST(AdvanceMotion, LetsAFreeBodyFallExactlyAsImplicitEulerDoes) {
  TissueModel model = heavy_block();
  for (auto& axes : model.is_fixed) axes = {false, false, false};
  Motion motion = motion_at_rest(model, rest_state(model));
  MotionSettings settings{.step_s = 0.004};
  constexpr int kSteps = 5;
  step(model, motion, settings, kSteps);
  // v_n = g h n and x_n = g h² n (n + 1) / 2.
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    EXPECT_NEAR(motion.velocities_mm_s[v][2], -9810 * 0.004 * kSteps, 1e-8);
    const Vec3 fallen = motion.tissue.positions[v] - model.mesh.vertices[v];
    EXPECT_LT((fallen - Vec3(0, 0, -9810 * 0.004 * 0.004 * kSteps * (kSteps + 1) / 2)).norm(), 1e-9);
  }
  EXPECT_DOUBLE_EQ(motion.time_s, 0.02);
}

TEST(AdvanceMotion, NeverGainsEnergy) {
  Material material{.poissons_ratio = 0.45};
  const TissueModel model =
      make_tissue_model(make_block(Vec3(20, 6, 6), {6, 2, 2}), material, {FixedConstraint{plane_x(0.0)}});
  TissueState stretched = rest_state(model);
  for (Vec3& p : stretched.positions) p.x() *= 1.15;
  Motion motion = motion_at_rest(model, stretched);
  MotionSettings settings{.step_s = 2e-4, .max_newton_iterations = 20, .relative_tolerance = 1e-9};
  const double start = elastic_energy_uj(model, motion.tissue);
  double before = start;
  for (int i = 0; i < 60; ++i) {
    step(model, motion, settings);
    const double now = elastic_energy_uj(model, motion.tissue) + kinetic_energy_uj(model, motion);
    ASSERT_LE(now, before + 1e-9 * start) << "step " << i;
    before = now;
  }
  EXPECT_LT(before, 0.9 * start);
  EXPECT_GT(before, 0.0);
}

TEST(AdvanceMotion, SwingsWithThePeriodOfABar) {
  // A bar without lateral contraction, fixed at one end: T = 4 L sqrt(rho / E).
  Material material{.poissons_ratio = 0.0};
  const TissueModel model =
      make_tissue_model(make_block(Vec3(20, 2, 2), {16, 1, 1}), material, {FixedConstraint{plane_x(0.0)}});
  const double period = 4.0 * 20.0 * std::sqrt(1040e-9 / 70.0);
  TissueState pulled = rest_state(model);
  for (Vec3& p : pulled.positions) p.x() += 0.2 * std::sin(std::numbers::pi * p.x() / 40.0);  // the first mode
  Motion motion = motion_at_rest(model, pulled);
  MotionSettings settings{.step_s = period / 800.0};
  Workers workers(1);
  MotionWorkspace workspace(model, settings);
  std::vector<double> crossings;
  const std::size_t tip = model.mesh.vertices.size() - 1;
  double last = motion.tissue.positions[tip].x() - 20.0;
  while (crossings.size() < 3 && motion.time_s < 2.0 * period) {
    ASSERT_EQ(advance_motion(model, motion, settings, workspace, workers).outcome, Outcome::Success);
    const double now = motion.tissue.positions[tip].x() - 20.0;
    if (now * last < 0.0) crossings.push_back(motion.time_s - settings.step_s * now / (now - last));
    last = now;
  }
  ASSERT_EQ(crossings.size(), 3U);
  EXPECT_NEAR(crossings[2] - crossings[0], period, 0.01 * period);
}

TEST(AdvanceMotion, MatchesTheClosedFormOfADampedStepForOneDegreeOfFreedom) {
  // Every vertex may move along z only and moves alike: no strain, so that alpha is all that slows it down.
  TissueModel model = heavy_block();
  for (auto& axes : model.is_fixed) axes = {true, true, false};
  for (Vec3& load : model.dead_load_mn) load = Vec3::Zero();
  Motion motion = motion_at_rest(model, rest_state(model));
  motion.velocities_mm_s.assign(motion.velocities_mm_s.size(), Vec3(0, 0, 50));
  MotionSettings settings{.rayleigh_alpha = 20.0};
  step(model, motion, settings, 3);
  for (const Vec3& v : motion.velocities_mm_s) EXPECT_NEAR(v.z(), 50.0 / std::pow(1.0 + 0.01 * 20.0, 3), 1e-9);
}

TEST(AdvanceMotion, StiffnessDampingBringsABodyToRestSooner) {
  const TissueModel model = heavy_block();
  const auto energy_after = [&](double beta) {
    Motion motion = motion_at_rest(model, rest_state(model));
    MotionSettings settings{.step_s = 1e-3, .rayleigh_beta = beta};
    step(model, motion, settings, 40);
    return kinetic_energy_uj(model, motion);
  };
  EXPECT_LT(energy_after(0.02), 0.2 * energy_after(0.0));
}

TEST(AdvanceMotion, DampingIsTheSameForceInEveryNewtonIteration) {
  // With rotations that hardly turn the step's equation is linear: more iterations must not move the answer.
  TissueModel model = clamped_block();
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p.x() *= 1.0001;
  MotionSettings settings{.rayleigh_beta = 0.1, .relative_tolerance = 1e-10};
  Motion one = motion_at_rest(model, state);
  step(model, one, settings);
  settings.max_newton_iterations = 5;
  settings.relative_tolerance = 1e-8;
  Motion several = motion_at_rest(model, state);
  step(model, several, settings);
  double way = 0.0;
  double off = 0.0;
  for (std::size_t v = 0; v < state.positions.size(); ++v) {
    way = std::max(way, (one.tissue.positions[v] - state.positions[v]).norm());
    off = std::max(off, (one.tissue.positions[v] - several.tissue.positions[v]).norm());
  }
  EXPECT_GT(way, 0.0);
  EXPECT_LT(off, 1e-2 * way) << "what a strain of 1e-4 turns";
}

TEST(AdvanceMotion, QuasiStaticStepsEndInStaticEquilibrium) {
  const TissueModel model = heavy_block();
  const StaticResult expected = testing::solve(model);
  ASSERT_EQ(expected.outcome, Outcome::Success);
  MotionSettings settings{.has_inertia = false, .max_newton_iterations = 30};
  Motion motion = motion_at_rest(model, rest_state(model));
  step(model, motion, settings);
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    ASSERT_LT((motion.tissue.positions[v] - expected.state.positions[v]).norm(), 1e-4);
  }
}

TEST(AdvanceMotion, ViscousTissueLetsGoOfItsStressAtTheRateOfItsTerm) {
  // A bar that cannot contract: its modulus 4/3 mu + K falls with mu alone, by one exponential.
  Material material{.poissons_ratio = 0.3, .prony = {{1.0, 0.1}}};
  const Region everywhere = BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(21, 7, 7))};
  const TissueModel model = make_tissue_model(make_block(Vec3(20, 6, 6), {4, 2, 2}), material,
                                              {FixedConstraint{plane_x(0.0)}, FixedConstraint{plane_x(20.0)},
                                               FixedConstraint{everywhere, {false, true, true}}});
  MotionSettings settings{.has_inertia = false, .max_newton_iterations = 20};
  Motion motion = motion_at_rest(model, rest_state(model));
  const std::vector<VertexId> end = select(model.mesh, plane_x(20.0));
  settings.step_s = 1e-3;  // far below the relaxation time: a sudden pull by 0.2 mm
  for (const VertexId v : end) motion.velocities_mm_s[v.index()] = Vec3(200, 0, 0);
  step(model, motion, settings);
  for (const VertexId v : end) motion.velocities_mm_s[v.index()] = Vec3::Zero();
  Workers workers(1);
  const auto pull = [&] {
    TissueState state = motion.tissue;
    Points forces(model.mesh.vertices.size(), Vec3::Zero());
    add_elastic_response(model, state, forces, nullptr, workers);
    add_viscous_response(model, state, 1e-9, forces, nullptr, workers);
    double sum = 0.0;
    for (const VertexId v : end) sum -= forces[v.index()].x();
    return sum;
  };
  const double sudden = pull();
  settings.step_s = 0.01;
  step(model, motion, settings, 10);  // one relaxation time
  const double after_one = pull();
  step(model, motion, settings, 90);
  const double last = pull();
  EXPECT_GT(sudden, 1.2 * last);
  EXPECT_NEAR((after_one - last) / (sudden - last), std::exp(-1.0), 0.005);
}

TEST(AdvanceMotion, HeldAxesMoveAsFastAsTheirHolder) {
  const TissueModel model = clamped_block();
  Motion motion = motion_at_rest(model, rest_state(model));
  for (const VertexId v : select(model.mesh, plane_x(0.0))) motion.velocities_mm_s[v.index()] = Vec3(0, 3, 0);
  MotionSettings settings{.has_inertia = false};
  step(model, motion, settings, 4);
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {  // the whole body goes along
    EXPECT_LT((motion.tissue.positions[v] - model.mesh.vertices[v] - Vec3(0, 0.12, 0)).norm(), 1e-5);
  }
}

TEST(AdvanceMotion, TakesAppliedForces) {
  const TissueModel model = clamped_block();
  Points force(model.mesh.vertices.size(), Vec3::Zero());
  force.back() = Vec3(0, 0, 10);
  Motion motion = motion_at_rest(model, rest_state(model));
  MotionSettings settings;
  Workers workers(1);
  MotionWorkspace workspace(model, settings);
  ASSERT_EQ(advance_motion(model, motion, settings, workspace, workers, force).outcome, Outcome::Success);
  EXPECT_GT(motion.velocities_mm_s.back().z(), 0.0);
}

TEST(AdvanceMotion, GivesTheSameBitsAtAnyThreadCountAndFromACopy) {
  const TissueModel model = clamped_block({8, 6, 5});
  for (const LinearSolver solver : {LinearSolver::Cholesky, LinearSolver::ConjugateGradients}) {
    MotionSettings settings;
    settings.step_s = 1e-3;
    settings.rayleigh_beta = 1e-3;
    settings.solver = solver;
    settings.max_newton_iterations = 3;
    settings.relative_tolerance = 1e-3;
    TissueState state = rest_state(model);
    for (Vec3& p : state.positions) p.x() *= 1.1;
    Motion one = motion_at_rest(model, state);
    Motion two = one;
    step(model, one, settings, 6, 1);
    step(model, two, settings, 2, 2);
    Motion resumed = two;  // with a new workspace
    step(model, resumed, settings, 4, 1);
    EXPECT_EQ(resumed.tissue.positions, one.tissue.positions);
    EXPECT_EQ(resumed.velocities_mm_s, one.velocities_mm_s);
    EXPECT_EQ(resumed.tissue.rotations, one.tissue.rotations);
    EXPECT_EQ(resumed.tissue.memory, one.tissue.memory);
  }
}

TEST(AdvanceMotion, SolversAgree) {
  const TissueModel model = heavy_block();
  Motion direct = motion_at_rest(model, rest_state(model));
  Motion iterated = direct;
  MotionSettings settings{.relative_tolerance = 1e-10, .solver = LinearSolver::Cholesky};
  EXPECT_EQ(step(model, direct, settings, 5).linear_iterations, 0);
  settings.solver = LinearSolver::ConjugateGradients;
  EXPECT_GT(step(model, iterated, settings, 5).linear_iterations, 5);
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    ASSERT_LT((direct.tissue.positions[v] - iterated.tissue.positions[v]).norm(), 1e-7);
  }
}

TEST(AdvanceMotion, LeavesTheMotionAloneWhenItDoesNotConverge) {
  const TissueModel model = heavy_block();
  Motion motion = motion_at_rest(model, rest_state(model));
  MotionSettings settings{.solver = LinearSolver::ConjugateGradients, .max_cg_iterations = 2};
  Workers workers(1);
  MotionWorkspace workspace(model, settings);
  EXPECT_EQ(advance_motion(model, motion, settings, workspace, workers).outcome, Outcome::NotConverged);
  EXPECT_EQ(motion.tissue.positions, model.mesh.vertices);
  EXPECT_EQ(motion.time_s, 0.0);
}

TEST(AdvanceMotion, GivesWayToCholeskyWhenLeftToChoose) {
  const TissueModel model = make_tissue_model(make_block(Vec3(30, 30, 15), {17, 17, 10}), {},
                                              {FixedConstraint{plane_x(0.0)}}, Vec3(0, 0, -9810));
  Motion motion = motion_at_rest(model, rest_state(model));
  MotionSettings settings{.has_inertia = false, .max_cg_iterations = 3};
  EXPECT_EQ(step(model, motion, settings).linear_iterations, 3);
}

TEST(AdvanceMotion, RefusesSettingsOutOfRange) {
  const TissueModel model = clamped_block();
  MotionSettings settings{.step_s = 0.0};
  EXPECT_THROW(MotionWorkspace(model, settings), InvalidArgument);
  settings = {};
  settings.rayleigh_beta = -1.0;
  EXPECT_THROW(MotionWorkspace(model, settings), InvalidArgument);
  settings = {};
  settings.relative_tolerance = 1.0;
  EXPECT_THROW(MotionWorkspace(model, settings), InvalidArgument);
}

}  // namespace
}  // namespace incise
