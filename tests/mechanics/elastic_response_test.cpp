#include "mechanics/bodies.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/tissue.hpp>

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace incise {
namespace {

using testing::block_of;
using testing::clamped_block;
using testing::dense;
using testing::elastic_forces;
using testing::kDifferenceStep;
using testing::kDifferenceTolerance;
using testing::kRounding;
using testing::largest;
using testing::norm;
using testing::shaken;
using testing::some_rotation;

TissueModel one_tet(double nu = 0.45) {
  Material material{.poissons_ratio = nu};
  return testing::one_tet(material);
}

Eigen::MatrixXd force_differences(const TissueModel& model, const TissueState& start) {
  return testing::force_differences(start, kDifferenceStep,
                                    [&](TissueState& state) { return elastic_forces(model, state); });
}

TEST(ElasticForce, PushesAMirroredTetBackThroughItsThinnestDirection) {
  const TissueModel model = one_tet();
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p[2] *= -0.5;  // mirrored in z, and thinner there than across
  const Points forces = elastic_forces(model, state);
  double power = 0.0;  // of the forces in the motion that mirrors it back
  for (std::size_t v = 0; v < 4; ++v) power += forces[v].dot(Vec3(0, 0, model.mesh.vertices[v][2]));
  EXPECT_GT(power, 0.0);
  EXPECT_NEAR(state.rotations[0].determinant(), 1.0, kRounding);
}

TEST(ElasticForce, VanishesUnderARigidMotion) {
  const TissueModel model = clamped_block();
  for (const double angle : {0.1, 1.0, 3.1}) {
    TissueState state = rest_state(model);
    for (Vec3& p : state.positions) p = some_rotation(angle) * p + Vec3(100, -50, 30);
    // Stress from rounding: λ times the relative rounding of positions near 120 mm in tets of 3 mm.
    EXPECT_LT(largest(elastic_forces(model, state)), 1e-8) << "turned by " << angle;
    EXPECT_LT(elastic_energy_uj(model, state), 1e-15);
  }
}

TEST(ElasticForce, TurnsWithTheBody) {
  const TissueModel model = clamped_block();
  TissueState state = shaken(model, 0.8, 2);
  const Points forces = elastic_forces(model, state);
  TissueState turned = shaken(model, 0.8, 2);
  for (Vec3& p : turned.positions) p = some_rotation() * p;
  const Points turned_forces = elastic_forces(model, turned);
  for (std::size_t v = 0; v < forces.size(); ++v) {
    EXPECT_LT((turned_forces[v] - some_rotation() * forces[v]).norm(), 1e-11 * largest(forces)) << "vertex " << v;
  }
  EXPECT_NEAR(elastic_energy_uj(model, turned), elastic_energy_uj(model, state),
              1e-11 * elastic_energy_uj(model, state));
}

TEST(ElasticForce, AddsUpToNothing) {
  const TissueModel model = clamped_block();
  TissueState state = shaken(model, 0.8, 2);
  const Points forces = elastic_forces(model, state);
  Vec3 sum = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (std::size_t v = 0; v < forces.size(); ++v) {
    sum += forces[v];
    moment += state.positions[v].cross(forces[v]);
  }
  EXPECT_LT(sum.norm(), 1e-11 * norm(forces));
  EXPECT_LT(moment.norm(), 1e-10 * norm(forces));
}

TEST(ElasticStiffness, IsSymmetricBitForBit) {
  const TissueModel model = clamped_block();
  TissueState state = shaken(model, 0.8, 2);
  BlockMatrix stiffness(model.pattern);
  elastic_forces(model, state, &stiffness);
  const Eigen::MatrixXd k = dense(stiffness);
  EXPECT_EQ((k - k.transpose()).norm(), 0.0);
}

TEST(ElasticStiffness, IsTheForceDerivativeAtZeroStrainInAnyOrientation) {
  const TissueModel model = clamped_block({2, 2, 2});
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p = some_rotation() * p;
  BlockMatrix stiffness(model.pattern);
  elastic_forces(model, state, &stiffness);
  const Eigen::MatrixXd expected = force_differences(model, state);
  EXPECT_LT((dense(stiffness) - expected).norm(), kDifferenceTolerance * expected.norm());
}

/// What the frozen tangent leaves out is the turn of the rotations under stress: proportional to the strain.
TEST(ElasticStiffness, DiffersFromTheForceDerivativeInProportionToTheStrain) {
  const TissueModel model = clamped_block({2, 2, 2});
  const auto remainder = [&](double strain) {
    TissueState state = rest_state(model);
    for (Vec3& p : state.positions) p[0] *= 1.0 + strain;
    BlockMatrix stiffness(model.pattern);
    elastic_forces(model, state, &stiffness);
    const Eigen::MatrixXd exact = force_differences(model, state);
    return (dense(stiffness) - exact).norm() / exact.norm();
  };
  const double at_two_percent = remainder(0.02);
  EXPECT_GT(at_two_percent, 1e-3);
  EXPECT_LT(at_two_percent, 0.05);
  EXPECT_NEAR(remainder(0.01) / at_two_percent, 0.5, 0.05);
}

TEST(ElasticResponse, KeepsItsRotationsOrthonormalOverThousandsOfUpdates) {
  const TissueModel model = one_tet();
  TissueState state = rest_state(model);
  Random random(8);
  for (int step = 0; step < 5000; ++step) {
    const Mat3 turn = Eigen::AngleAxisd(0.1, Vec3(1, 0.3 * std::sin(step), 0.2).normalized()).toRotationMatrix();
    for (Vec3& p : state.positions) p = turn * p;
    elastic_forces(model, state);
  }
  EXPECT_LT((state.rotations[0].transpose() * state.rotations[0] - Mat3::Identity()).norm(), 1e-11);
}

TEST(ElasticResponse, RefusesAStateOfAnotherMesh) {
  const TissueModel model = clamped_block();
  TissueState state = rest_state(one_tet());
  EXPECT_THROW(elastic_forces(model, state), InvalidArgument);
}

}  // namespace
}  // namespace incise
