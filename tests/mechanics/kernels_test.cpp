#include "mechanics/bodies.hpp"

#include <incise/core/isa.hpp>
#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::clamped_block;
using testing::elastic_forces;
using testing::norm;
using testing::shaken;

constexpr double kDoubleTolerance =
    1e-12;  // of the largest entry: sums of some 30 terms in another order, with and without fused rounding

/// Runs each test with the instruction set of its parameter and puts the best one back.
class Kernels : public ::testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << "this machine lacks " << to_string(GetParam());
  }
  void TearDown() override { set_isa(best_isa()); }
};

struct Response {
  TissueState state;
  Points forces;
  BlockMatrix stiffness;
  double energy_uj;
};

Response response(const TissueModel& model, const TissueState& start, Isa isa, int threads = 1) {
  set_isa(isa);
  Response r{start, {}, BlockMatrix(model.pattern), 0.0};
  r.energy_uj = elastic_energy_uj(model, start);
  r.forces = elastic_forces(model, r.state, &r.stiffness, threads);
  return r;
}

double largest_entry(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

void expect_same(const Response& found, const Response& expected) {
  const double scale = testing::largest(expected.forces);
  for (std::size_t v = 0; v < expected.forces.size(); ++v) {
    ASSERT_LE((found.forces[v] - expected.forces[v]).norm(), kDoubleTolerance * scale) << "force on vertex " << v;
  }
  const double stiffest = largest_entry(expected.stiffness.values);
  for (std::size_t i = 0; i < expected.stiffness.values.size(); ++i) {
    ASSERT_NEAR(found.stiffness.values[i], expected.stiffness.values[i], kDoubleTolerance * stiffest) << "entry " << i;
  }
  EXPECT_NEAR(found.energy_uj, expected.energy_uj, kDoubleTolerance * expected.energy_uj);
}

TEST_P(Kernels, GiveTheResponseOfThePortableOnes) {
  const TissueModel model = clamped_block({5, 4, 3}, 0.49);  // 360 tets: not a whole number of runs
  const TissueState state = shaken(model, 0.4, 3);
  expect_same(response(model, state, GetParam()), response(model, state, Isa::Portable));
}

TEST_P(Kernels, LeaveCarvedTetsOut) {
  const TissueModel model = clamped_block({5, 4, 3}, 0.49);
  TissueState state = shaken(model, 0.4, 3);
  for (std::size_t t = 0; t < state.is_live.size(); t += 3) state.is_live[t] = 0;
  const TissueState before = state;
  const Response found = response(model, state, GetParam());
  expect_same(found, response(model, state, Isa::Portable));
  for (std::size_t t = 0; t < state.is_live.size(); t += 3) EXPECT_EQ(found.state.rotations[t], before.rotations[t]);
}

TEST_P(Kernels, AgreeOnTetsThatAreTurnedInsideOutOrFlat) {
  const TissueModel model = clamped_block({5, 4, 3}, 0.45);
  TissueState state = shaken(model, 4.0, 11);  // cells are 3 to 4 mm wide
  for (std::size_t v = 0; v < 20; ++v) state.positions[v].z() = 1.0;
  const Response found = response(model, state, GetParam());
  expect_same(found, response(model, state, Isa::Portable));
  for (const Mat3& r : found.state.rotations) {
    EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
    EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), 1e-12);
  }
}

TEST_P(Kernels, GiveTheSameBitsAtAnyThreadCount) {
  const TissueModel model = clamped_block({12, 10, 8}, 0.49);  // a dozen runs in several colours
  const TissueState state = shaken(model, 0.2, 5);
  const Response one = response(model, state, GetParam(), 1);
  for (const int threads : {2, 3}) {
    const Response many = response(model, state, GetParam(), threads);
    EXPECT_EQ(many.forces, one.forces);
    EXPECT_EQ(many.stiffness.values, one.stiffness.values);
    EXPECT_EQ(many.state.rotations, one.state.rotations);
  }
}

TEST_P(Kernels, MakeATangentThatIsSymmetricToTheLastBit) {
  const TissueModel model = clamped_block({5, 4, 3}, 0.49);
  const Response r = response(model, shaken(model, 0.4, 3), GetParam());
  const Eigen::MatrixXd k = testing::dense(r.stiffness);
  EXPECT_EQ((k - k.transpose()).cwiseAbs().maxCoeff(), 0.0);
}

TEST_P(Kernels, MultiplyAsADenseMatrixDoes) {
  const TissueModel model = clamped_block({5, 4, 3}, 0.49);
  const Response r = response(model, shaken(model, 0.4, 3), GetParam());
  const Points x = shaken(model, 3.0, 17).positions;
  Eigen::VectorXd flat(3 * x.size());
  for (std::size_t v = 0; v < x.size(); ++v) flat.segment<3>(static_cast<Eigen::Index>(3 * v)) = x[v];
  const Eigen::VectorXd expected = testing::dense(r.stiffness) * flat;
  Workers workers(2);
  Points y(x.size());
  multiply(r.stiffness, x, y, workers);
  for (std::size_t v = 0; v < x.size(); ++v) {
    const Vec3 e = expected.segment<3>(static_cast<Eigen::Index>(3 * v));
    ASSERT_LE((y[v] - e).norm(), kDoubleTolerance * expected.cwiseAbs().maxCoeff()) << "vertex " << v;
  }
}

TEST_P(Kernels, SolveWithAMatrixOfSixteenBits) {
  const TissueModel model = clamped_block({5, 4, 3}, 0.49);
  Response r = response(model, rest_state(model), GetParam());
  Points right(model.mesh.vertices.size(), Vec3::Zero());
  for (const VertexId v : select(model.mesh, EndRegion{Vec3::UnitX(), 4.0})) right[v.index()] = Vec3(3, -1, 2);
  hold_constrained(model, r.stiffness, right);
  Workers workers(2);
  PcgSettings settings{.relative_tolerance = 1e-6};
  Points exact(right.size());
  Points rounded(right.size());
  for (const Precision precision : {Precision::Double, Precision::Single}) {
    TwoLevelPcg solver(model.pattern, model.mesh.vertices, 20, precision);
    solver.update(r.stiffness, true, workers);
    settings.relative_tolerance = precision == Precision::Double ? 1e-8 : 1e-4;
    EXPECT_TRUE(solver.solve(r.stiffness, right, precision == Precision::Double ? exact : rounded, settings, workers)
                    .converged);
  }
  for (std::size_t v = 0; v < right.size(); ++v) {
    ASSERT_LE((rounded[v] - exact[v]).norm(), 5e-3 * testing::largest(exact)) << "vertex " << v;
  }
}

TEST_P(Kernels, FindTheSameEquilibrium) {
  const TissueModel model = make_tissue_model(
      make_block(Vec3(40, 20, 12), {8, 4, 3}), {},
      {FixedConstraint{testing::plane_x(0.0)}, DisplacedConstraint{testing::plane_x(40.0), Vec3(8, 2, 0)}});
  const auto solve = [&](Isa isa) {
    set_isa(isa);
    return testing::solve(model, {.relative_tolerance = 1e-10});
  };
  const StaticResult found = solve(GetParam());
  const StaticResult expected = solve(Isa::Portable);
  ASSERT_EQ(found.outcome, Outcome::Success);
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    ASSERT_LT((found.state.positions[v] - expected.state.positions[v]).norm(), 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, Kernels, ::testing::Values(Isa::Portable, Isa::Avx2, Isa::Avx512),
                         [](const auto& which) { return std::string(to_string(which.param)); });

}  // namespace
}  // namespace incise
