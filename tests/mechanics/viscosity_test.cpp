#include "mechanics/bodies.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/tissue.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using testing::irregular_block;
using testing::kRounding;
using testing::largest;
using testing::norm;
using testing::plane_x;
using testing::some_rotation;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kSize(20, 12, 9);

TissueModel block(const Material& material) {
  return make_tissue_model(irregular_block(kSize, {2, 2, 2}, 0.2, 7), material, {FixedConstraint{plane_x(0.0)}});
}

Material with_prony(std::vector<PronyTerm> terms) {
  Material material{.prony = std::move(terms)};
  return material;
}

void map(const TissueModel& model, TissueState& state, const Mat3& f) {
  for (std::size_t v = 0; v < state.positions.size(); ++v) state.positions[v] = f * model.mesh.vertices[v];
}

Points viscous_forces(const TissueModel& model, const TissueState& state, double step_s) {
  Workers workers(1);
  Points forces(state.positions.size(), Vec3::Zero());
  add_viscous_response(model, state, step_s, forces, nullptr, workers);
  return forces;
}

void end_step(const TissueModel& model, TissueState& state, double step_s) {
  Workers workers(1);
  end_viscous_step(model, state, step_s, workers);
}

/// Mean second Piola stress of a linear field: Σ X fᵀ = −V Pᵀ, S = F⁻¹ P.
Mat3 mean_stress(const TissueModel& model, const Points& forces, const Mat3& f) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t v = 0; v < forces.size(); ++v) sum -= forces[v] * model.mesh.vertices[v].transpose();
  return f.inverse() * (sum / kSize.prod());
}

Mat3 stretched(double amount) {
  Mat3 f = Mat3::Identity();
  f(0, 0) += amount;
  f(1, 2) += 0.5 * amount;
  return f;
}
Mat3 strain_deviator(const Mat3& f) {
  const Mat3 strain = 0.5 * (f.transpose() * f - Mat3::Identity());
  return strain - strain.trace() / 3.0 * Mat3::Identity();
}

TEST(Viscosity, IsOffByDefault) {
  const TissueModel model = block(Material{});
  TissueState state = testing::shaken(model, 0.5, 1);
  EXPECT_EQ(state.memory, ViscousMemory{});
  EXPECT_EQ(largest(viscous_forces(model, state, 0.1)), 0.0);
  end_step(model, state, 0.1);
  EXPECT_EQ(state.memory, ViscousMemory{});
}

TEST(Viscosity, OfOnePronyTermRelaxesExponentiallyUnderHeldStrain) {
  const double step = 0.02;
  const TissueModel model = block(with_prony({{0.8, 0.1}}));
  const Mat3 f = stretched(0.1);
  TissueState state = rest_state(model);
  map(model, state, f);
  const Mat3 instant = 2.0 * 0.8 * model.lame[0].mu_kpa * strain_deviator(f);
  for (int i = 0; i < 40; ++i) {
    // The strain came halfway through the first step.
    const double time = (i + 0.5) * step;
    const Mat3 expected = std::exp(-time / 0.1) * instant;
    const Mat3 found = mean_stress(model, viscous_forces(model, state, step), f);
    EXPECT_LT((found - expected).norm(), kRounding * instant.norm()) << "after " << time << " s";
    end_step(model, state, step);
  }
}

TEST(Viscosity, ForgetsAtTheSameRateWhateverTheStep) {
  const TissueModel model = block(with_prony({{0.8, 0.1}}));
  TissueState fine = rest_state(model);
  map(model, fine, stretched(0.1));
  end_step(model, fine, 0.02);
  TissueState coarse = fine;
  for (int i = 0; i < 10; ++i) end_step(model, fine, 0.02);
  end_step(model, coarse, 0.2);
  for (std::size_t i = 0; i < fine.memory.branches.size(); ++i) {
    EXPECT_LT((fine.memory.branches[i] - coarse.memory.branches[i]).norm(), kRounding);
  }
}

/// Against the convolution q = ∫ exp(−(T − t)/τ) dD/dt dt of a strain that grows as sin², at T = 0.4 s.
TEST(Viscosity, ConvergesWithTheSquareOfTheStep) {
  const TissueModel model = block(with_prony({{0.8, 0.1}}));
  const auto deviator_at = [](double t) { return strain_deviator(stretched(0.2 * std::pow(std::sin(4.0 * t), 2))); };
  Mat3 expected = Mat3::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double t0 = 0.4 * i / kSamples;
    const double t1 = 0.4 * (i + 1) / kSamples;
    expected += std::exp(-(0.4 - 0.5 * (t0 + t1)) / 0.1) * (deviator_at(t1) - deviator_at(t0));
  }
  const auto error_with = [&](int steps) {
    TissueState state = rest_state(model);
    for (int i = 1; i <= steps; ++i) {
      map(model, state, stretched(0.2 * std::pow(std::sin(4.0 * 0.4 * i / steps), 2)));
      end_step(model, state, 0.4 / steps);
    }
    return (state.memory.branches[0] - expected).norm() / expected.norm();
  };
  const double coarse = error_with(16);
  EXPECT_LT(coarse, 0.02);
  EXPECT_NEAR(std::log2(coarse / error_with(32)), 2.0, 0.1);
}

TEST(Viscosity, OfKelvinAndVoigtIsProportionalToTheRateOfStrain) {
  Material material{.kelvin_voigt_time_s = 0.3};
  const TissueModel model = block(material);
  TissueState state = rest_state(model);
  map(model, state, stretched(0.05));
  end_step(model, state, 0.1);
  const Mat3 f = stretched(0.06);
  map(model, state, f);
  const Mat3 rate = (strain_deviator(f) - strain_deviator(stretched(0.05))) / 0.02;
  const Mat3 expected = 2.0 * 0.3 * model.lame[0].mu_kpa * rate;
  EXPECT_LT((mean_stress(model, viscous_forces(model, state, 0.02), f) - expected).norm(), 1e-11 * expected.norm());
}

TEST(Viscosity, DoesNotResistARigidMotion) {
  Material material = with_prony({{0.8, 0.1}});
  material.kelvin_voigt_time_s = 0.3;
  const TissueModel model = block(material);
  TissueState state = rest_state(model);
  map(model, state, some_rotation());
  EXPECT_LT(largest(viscous_forces(model, state, 0.01)), 1e-9);
}

TEST(Viscosity, IsGoneAfterAnInfiniteStep) {
  Material material = with_prony({{0.8, 0.1}, {0.2, 100.0}});
  material.kelvin_voigt_time_s = 0.3;
  const TissueModel model = block(material);
  TissueState state = testing::shaken(model, 0.5, 1);
  EXPECT_EQ(largest(viscous_forces(model, state, kInfinity)), 0.0);
  end_step(model, state, kInfinity);
  EXPECT_EQ(largest(viscous_forces(model, state, 0.01)), 0.0);
  EXPECT_GT(norm(viscous_forces(model, rest_state(model), 0.01)) + state.memory.strains[0].norm(), 0.0);
}

TEST(Viscosity, LeavesTheElasticResponseAlone) {
  const TissueModel viscous = block(with_prony({{0.8, 0.1}}));
  const TissueModel elastic = block(Material{});
  TissueState a = testing::shaken(viscous, 0.5, 1);
  TissueState b = testing::shaken(elastic, 0.5, 1);
  EXPECT_EQ(testing::elastic_forces(viscous, a), testing::elastic_forces(elastic, b));
}

TEST(Viscosity, RefusesAMatrixOfAnotherPattern) {
  const TissueModel model = block(with_prony({{0.8, 0.1}})), other = block(with_prony({{0.8, 0.1}}));
  const TissueState state = rest_state(model);
  Points forces(state.positions.size(), Vec3::Zero());
  BlockMatrix matrix(other.pattern);
  Workers workers(1);
  EXPECT_THROW(add_viscous_response(model, state, 0.1, forces, &matrix, workers), InvalidArgument);
}

TEST(Viscosity, RefusesAStepOfNoLengthAndTheMemoryOfAnotherModel) {
  const TissueModel model = block(with_prony({{0.8, 0.1}}));
  TissueState state = rest_state(model);
  EXPECT_THROW(viscous_forces(model, state, 0.0), InvalidArgument);
  EXPECT_THROW(viscous_forces(model, state, std::numeric_limits<double>::quiet_NaN()), InvalidArgument);
  EXPECT_THROW(end_step(model, state, -1.0), InvalidArgument);
  state.memory = rest_state(block(Material{})).memory;
  EXPECT_THROW(viscous_forces(model, state, 0.1), InvalidArgument);
  EXPECT_THROW(static_cast<void>(viscous_potential_uj(model, state, 0.1)), InvalidArgument);
}

}  // namespace
}  // namespace incise
