// One suite for every law: what must hold whatever the tissue is made of.
#include "mechanics/bodies.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/mechanics/tissue.hpp>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace incise {
namespace {

using testing::dense;
using testing::irregular_block;
using testing::kDifferenceStep;
using testing::kDifferenceTolerance;
using testing::kRounding;
using testing::largest;
using testing::norm;
using testing::plane_x;
using testing::some_rotation;

constexpr double kStepS = 0.1;
const Vec3 kSize(20, 12, 9);

struct LawCase {
  const char* name;
  MaterialModel model;
  VolumeTreatment volume;
  bool has_fibres;
  bool is_viscous;
  bool stiffens = false;
};

Material material_of(const LawCase& law) {
  Material material{.model = law.model, .volume = law.volume, .poissons_ratio = 0.45};
  if (law.has_fibres) {
    material.fibre_modulus_kpa = 120.0;
    material.fibre_direction = Vec3(3.0, 1.0, -2.0);
  }
  if (law.stiffens && law.has_fibres) material.fibre_stiffening = 8.0;
  if (law.stiffens && law.model == MaterialModel::StableNeoHookean) material.stiffening = 0.8;
  if (law.is_viscous) {
    material.prony = {{0.8, 0.05}, {0.3, 1.0}};
    material.kelvin_voigt_time_s = 0.02;
  }
  return material;
}

class EveryLaw : public ::testing::TestWithParam<LawCase> {
 protected:
  [[nodiscard]] static TissueModel block(std::array<int, 3> cells = {2, 2, 2}) {
    return make_tissue_model(irregular_block(kSize, cells, 0.2, 7), material_of(GetParam()),
                             {FixedConstraint{plane_x(0.0)}});
  }
  [[nodiscard]] static TissueModel one_tet() { return testing::one_tet(material_of(GetParam())); }

  /// Shaken, after a first step to another shaken place: viscous tissue then remembers something.
  [[nodiscard]] static TissueState shaken(const TissueModel& model, double amount, std::uint64_t seed) {
    Workers workers(1);
    TissueState state = testing::shaken(model, 0.5 * amount, seed + 100);
    end_viscous_step(model, state, kStepS, workers);
    state.positions = testing::shaken(model, amount, seed).positions;
    return state;
  }
  /// The linear field x -> F x, remembered as undeformed.
  [[nodiscard]] static TissueState mapped(const TissueModel& model, const Mat3& f) {
    TissueState state = rest_state(model);
    for (Vec3& p : state.positions) p = f * p;
    return state;
  }

  [[nodiscard]] static double energy(const TissueModel& model, const TissueState& state) {
    return elastic_energy_uj(model, state) + viscous_potential_uj(model, state, kStepS);
  }
  static Points forces(const TissueModel& model, TissueState& state, BlockMatrix* stiffness = nullptr,
                       Tangent tangent = Tangent::Exact, int threads = 1) {
    Workers workers(threads);
    Points result(state.positions.size(), Vec3::Zero());
    add_elastic_response(model, state, result, stiffness, workers, tangent);
    add_viscous_response(model, state, kStepS, result, stiffness, workers, tangent);
    return result;
  }
  [[nodiscard]] static Eigen::MatrixXd stiffness(const TissueModel& model, TissueState state, Tangent tangent) {
    BlockMatrix matrix(model.pattern);
    forces(model, state, &matrix, tangent);
    return dense(matrix);
  }

  [[nodiscard]] static Points energy_gradient(const TissueModel& model, TissueState state) {
    Points gradient(state.positions.size());
    for (std::size_t v = 0; v < gradient.size(); ++v) {
      for (int i = 0; i < 3; ++i) {
        const double at = state.positions[v][i];
        state.positions[v][i] = at + kDifferenceStep;
        const double above = energy(model, state);
        state.positions[v][i] = at - kDifferenceStep;
        gradient[v][i] = (above - energy(model, state)) / (2.0 * kDifferenceStep);
        state.positions[v][i] = at;
      }
    }
    return gradient;
  }
  [[nodiscard]] static Eigen::MatrixXd force_differences(const TissueModel& model, const TissueState& start) {
    return testing::force_differences(start, kDifferenceStep, [&](TissueState& state) { return forces(model, state); });
  }
};

TEST_P(EveryLaw, OfHalfTheStiffnessHasHalfOfEverything) {
  const TissueModel model = block();
  TissueState whole = shaken(model, 0.4, 3), half = whole;
  half.fill.assign(model.mesh.tets.size(), 0.5);
  EXPECT_NEAR(energy(model, half), 0.5 * energy(model, whole), 1e-12 * energy(model, whole));
  const Eigen::MatrixXd expected = 0.5 * stiffness(model, whole, Tangent::Exact);
  EXPECT_LT((stiffness(model, half, Tangent::Exact) - expected).norm(), 1e-12 * expected.norm());
  const Points of_whole = forces(model, whole), of_half = forces(model, half);
  for (std::size_t v = 0; v < of_whole.size(); ++v)
    ASSERT_LT((of_half[v] - 0.5 * of_whole[v]).norm(), 1e-12 * norm(of_whole)) << "vertex " << v;
}

TEST_P(EveryLaw, OfPartlyEmptyTetsIsTheGradientOfItsEnergy) {
  const TissueModel model = block();
  TissueState state = shaken(model, 0.4, 4);
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t)
    state.fill.push_back(0.1 + 0.9 * static_cast<double>(t) / static_cast<double>(model.mesh.tets.size()));
  const Points found = forces(model, state), gradient = energy_gradient(model, state);
  for (std::size_t v = 0; v < found.size(); ++v)
    ASSERT_LT((found[v] + gradient[v]).norm(), kDifferenceTolerance * norm(found)) << "vertex " << v;
}

TEST_P(EveryLaw, HasForcesThatAreMinusTheEnergyGradient) {
  const TissueModel model = block();
  for (const double amount : {0.05, 0.5, 1.5}) {
    TissueState state = shaken(model, amount, 11);
    state.is_live[5] = 0;
    const Points gradient = energy_gradient(model, state);
    const Points found = forces(model, state);
    double difference = 0.0;
    for (std::size_t v = 0; v < found.size(); ++v) difference = std::max(difference, (found[v] + gradient[v]).norm());
    EXPECT_LT(difference, kDifferenceTolerance * largest(found)) << "shaken by " << amount << " mm";
    EXPECT_GT(difference, 0.0) << "the two are meant to be computed independently";
  }
}

TEST_P(EveryLaw, HasForcesThatAreMinusTheEnergyGradientOfInvertedTetsToo) {
  const TissueModel model = one_tet();
  Random random(5);
  int inverted = 0;
  for (int trial = 0; trial < 100; ++trial) {
    TissueState state = rest_state(model);
    for (Vec3& p : state.positions) p = Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
    const auto& p = state.positions;
    if (signed_volume(p[0], p[1], p[2], p[3]) < 0.0) ++inverted;
    const Points gradient = energy_gradient(model, state);
    const Points found = forces(model, state);
    for (std::size_t v = 0; v < 4; ++v) {
      // Near a flat tet the polar rotation turns fast, and central differences with it.
      EXPECT_LT((found[v] + gradient[v]).norm(), 1e-4 * largest(found)) << "trial " << trial << ", vertex " << v;
    }
  }
  EXPECT_GT(inverted, 25);
}

TEST_P(EveryLaw, HasAnExactTangentThatIsTheForceDerivative) {
  const TissueModel model = block();
  for (const double amount : {0.0, 0.3, 1.0}) {
    TissueState state = shaken(model, amount, 3);
    state.is_live[9] = 0;
    const Eigen::MatrixXd expected = force_differences(model, state);
    EXPECT_LT((stiffness(model, state, Tangent::Exact) - expected).norm(), kDifferenceTolerance * expected.norm())
        << "shaken by " << amount << " mm";
  }
}

TEST_P(EveryLaw, HasSymmetricTangents) {
  const TissueModel model = block();
  const TissueState state = shaken(model, 0.8, 2);
  for (const Tangent tangent : {Tangent::FrozenRotations, Tangent::Exact, Tangent::Projected}) {
    const Eigen::MatrixXd k = stiffness(model, state, tangent);
    EXPECT_LT((k - k.transpose()).norm(), kRounding * k.norm());
  }
}

TEST_P(EveryLaw, HasProjectedTangentsThatArePositiveSemidefiniteEvenFarFromRest) {
  const TissueModel model = block();
  const auto eigenvalues = [&](const TissueState& state, Tangent tangent) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness(model, state, tangent));
    return Eigen::VectorXd(solver.eigenvalues());
  };
  TissueState crushed = shaken(model, 1.0, 6);
  for (Vec3& p : crushed.positions) p *= 0.5;
  for (const TissueState& state : {shaken(model, 4.0, 2), crushed}) {
    for (const Tangent tangent : {Tangent::FrozenRotations, Tangent::Projected}) {
      const Eigen::VectorXd values = eigenvalues(state, tangent);
      EXPECT_GT(values.minCoeff(), -kRounding * values.maxCoeff());
    }
  }
  const Eigen::VectorXd exact = eigenvalues(crushed, Tangent::Exact);
  EXPECT_LT(exact.minCoeff(), -1e-3 * exact.maxCoeff()) << "the state is meant to need projection";
}

TEST_P(EveryLaw, HasTangentsThatAgreeAtRestInAnyOrientation) {
  const TissueModel model = block();
  const TissueState state = mapped(model, some_rotation());
  const Eigen::MatrixXd exact = stiffness(model, state, Tangent::Exact);
  // Stretches differ from 1 by rounding, and the fibre's and the turn's curvature with them.
  EXPECT_LT((stiffness(model, state, Tangent::Projected) - exact).norm(), 1e-10 * exact.norm());
  EXPECT_LT((stiffness(model, state, Tangent::FrozenRotations) - exact).norm(), 1e-10 * exact.norm());
}

TEST_P(EveryLaw, IsObjective) {
  const TissueModel model = block();
  TissueState state = shaken(model, 0.8, 2);
  const Points straight = forces(model, state);
  TissueState turned = state;
  for (Vec3& p : turned.positions) p = some_rotation() * p + Vec3(30, -20, 10);
  const Points found = forces(model, turned);
  for (std::size_t v = 0; v < found.size(); ++v) {
    EXPECT_LT((found[v] - some_rotation() * straight[v]).norm(), 1e-11 * largest(straight)) << "vertex " << v;
  }
  EXPECT_NEAR(energy(model, turned), energy(model, state), 1e-11 * std::abs(energy(model, state)));
}

TEST_P(EveryLaw, HasNoForceAndNoEnergyAtRest) {
  const TissueModel model = block({4, 3, 3});
  TissueState state = rest_state(model);
  EXPECT_LT(largest(forces(model, state)), 1e-10);  // mN; E times the area of a face is near 1000
  EXPECT_NEAR(energy(model, state), 0.0, 1e-10);
}

TEST_P(EveryLaw, IsFiniteForFlatCollapsedAndMirroredTets) {
  const TissueModel model = one_tet();
  const Vec3 diagonals[] = {Vec3::Zero(),     Vec3(1, 1, 0),   Vec3(1, 0, 0),        Vec3(1, 1, -1),
                            Vec3(-1, -1, -1), Vec3(1, -1, -1), Vec3(1, 1e-9, -1e-9), Vec3::Constant(1e8)};
  for (const Vec3& stretch : diagonals) {
    TissueState state = mapped(model, some_rotation() * stretch.asDiagonal());
    EXPECT_TRUE(std::isfinite(norm(forces(model, state)))) << stretch.transpose();
    EXPECT_TRUE(std::isfinite(energy(model, state))) << stretch.transpose();
    EXPECT_TRUE(std::isfinite(von_mises_kpa(model, state)[0])) << stretch.transpose();
    for (const Tangent tangent : {Tangent::FrozenRotations, Tangent::Exact, Tangent::Projected}) {
      EXPECT_TRUE(stiffness(model, state, tangent).allFinite()) << stretch.transpose();
    }
  }
}

TEST_P(EveryLaw, PushesAMirroredTetBack) {
  const TissueModel model = one_tet();
  TissueState state = mapped(model, Vec3(1, 1, -0.5).asDiagonal());
  const Points found = forces(model, state);
  double power = 0.0;  // of the forces in the motion that mirrors it back
  for (std::size_t v = 0; v < found.size(); ++v) power += found[v].dot(Vec3(0, 0, model.mesh.vertices[v][2]));
  EXPECT_GT(power, 0.0);
}

/// A linear field is in equilibrium at inner vertices, whatever the mesh.
TEST_P(EveryLaw, PassesThePatchTest) {
  const TissueModel model = block({5, 4, 4});
  Mat3 f;
  f << 1.2, 0.1, -0.05, 0.02, 0.9, 0.15, -0.1, 0.05, 1.1;
  TissueState state = mapped(model, some_rotation(0.7) * f);
  const Points found = forces(model, state);
  int inner = 0;
  for (std::size_t v = 0; v < found.size(); ++v) {
    const Vec3& rest = model.mesh.vertices[v];
    if ((rest.array() < 1e-9).any() || ((kSize - rest).array() < 1e-9).any()) continue;
    ++inner;
    EXPECT_LT(found[v].norm(), kRounding * largest(found)) << "vertex " << v;
  }
  EXPECT_EQ(inner, 4 * 3 * 3);
}

/// Stress of a small linear strain, from the virial of the forces: Σ x fᵀ = −V σ.
TEST_P(EveryLaw, IsLinearElasticityAtSmallStrain) {
  const TissueModel model = block();
  const Material& material = model.material;
  const double e = 1e-6;
  const auto stress = [&](const Mat3& strain) {
    TissueState state = mapped(model, Mat3::Identity() + strain);
    const Points found = forces(model, state);
    Mat3 sum = Mat3::Zero();
    for (std::size_t v = 0; v < found.size(); ++v) sum -= model.mesh.vertices[v] * found[v].transpose();
    return Mat3(sum / kSize.prod());
  };
  // Of Hooke's law in E and ν, of the fibres, and of the viscous branches over one step.
  double viscous = material.kelvin_voigt_time_s / kStepS;
  for (const PronyTerm& term : material.prony) viscous += term.shear_share * std::exp(-0.5 * kStepS / term.time_s);
  const double young = material.youngs_modulus_kpa;
  const double nu = material.poissons_ratio;
  const auto expected = [&](const Mat3& strain) {
    const Mat3 deviator = strain - strain.trace() / 3.0 * Mat3::Identity();
    Mat3 sigma = young / (1.0 + nu) * (strain + nu / (1.0 - 2.0 * nu) * strain.trace() * Mat3::Identity());
    sigma += young / (1.0 + nu) * viscous * deviator;
    const Vec3 a = material.fibre_direction.normalized();
    return Mat3(sigma + material.fibre_modulus_kpa * a.dot(strain * a) * a * a.transpose());
  };
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = shear(1, 0) = e;
  Mat3 mixed;
  mixed << 2 * e, -e, 0.5 * e, -e, -e, 0.7 * e, 0.5 * e, 0.7 * e, 0.3 * e;
  for (const Mat3& strain : {Mat3(Vec3(e, -nu * e, -nu * e).asDiagonal()), shear, mixed, Mat3(e * Mat3::Identity())}) {
    EXPECT_LT((stress(strain) - expected(strain)).norm(), 20.0 * e * expected(strain).norm());
  }
}

TEST_P(EveryLaw, GivesTheSameBitsAtAnyThreadCountWithAndWithoutStiffness) {
  const TissueModel model = block({8, 7, 7});
  TissueState one = shaken(model, 0.3, 9);
  const TissueState start = one;
  BlockMatrix one_stiffness(model.pattern);
  const Points expected = forces(model, one, &one_stiffness, Tangent::Projected, 1);
  TissueState plain = start;
  EXPECT_EQ(forces(model, plain), expected);
  for (const int threads : {2, 3}) {
    TissueState many = start;
    BlockMatrix many_stiffness(model.pattern);
    EXPECT_EQ(forces(model, many, &many_stiffness, Tangent::Projected, threads), expected) << threads << " threads";
    EXPECT_EQ(many_stiffness.values, one_stiffness.values) << threads << " threads";
    EXPECT_EQ(many.rotations, one.rotations) << threads << " threads";
    Workers workers(threads);
    Workers alone(1);
    TissueState after = start;
    end_viscous_step(model, many, kStepS, workers);
    end_viscous_step(model, after, kStepS, alone);
    EXPECT_EQ(many.memory, after.memory) << threads << " threads";
  }
}

TEST_P(EveryLaw, RefusesAMatrixOfAnotherPattern) {
  const TissueModel model = one_tet();
  TissueState state = rest_state(model);
  BlockMatrix other(block().pattern);
  EXPECT_THROW(forces(model, state, &other), InvalidArgument);
}

TEST_P(EveryLaw, LeavesNothingOfACarvedTet) {
  const TissueModel model = one_tet();
  TissueState state = shaken(model, 0.3, 4);
  state.is_live[0] = 0;
  EXPECT_EQ(largest(forces(model, state)), 0.0);
  EXPECT_EQ(energy(model, state), 0.0);
  EXPECT_EQ(stiffness(model, state, Tangent::Exact).norm(), 0.0);
  EXPECT_EQ(von_mises_kpa(model, state)[0], 0.0);
}

constexpr auto kCorotational = MaterialModel::Corotational;
constexpr auto kNeoHookean = MaterialModel::StableNeoHookean;
constexpr auto kPerTet = VolumeTreatment::PerTet;
constexpr auto kAveraged = VolumeTreatment::Averaged;

INSTANTIATE_TEST_SUITE_P(
    Laws, EveryLaw,
    ::testing::Values(LawCase{"Corotational", kCorotational, kPerTet, false, false},
                      LawCase{"CorotationalFibres", kCorotational, kPerTet, true, false},
                      LawCase{"CorotationalAveraged", kCorotational, kAveraged, false, false},
                      LawCase{"CorotationalAveragedFibres", kCorotational, kAveraged, true, false},
                      LawCase{"CorotationalViscous", kCorotational, kPerTet, false, true},
                      LawCase{"NeoHookean", kNeoHookean, kPerTet, false, false},
                      LawCase{"NeoHookeanFibres", kNeoHookean, kPerTet, true, false},
                      LawCase{"NeoHookeanAveraged", kNeoHookean, kAveraged, false, false},
                      LawCase{"NeoHookeanAveragedFibres", kNeoHookean, kAveraged, true, false},
                      LawCase{"NeoHookeanAveragedFibresViscous", kNeoHookean, kAveraged, true, true},
                      LawCase{"CorotationalStiffeningFibres", kCorotational, kPerTet, true, false, true},
                      LawCase{"NeoHookeanStiffening", kNeoHookean, kPerTet, false, false, true},
                      LawCase{"NeoHookeanAveragedStiffeningFibresViscous", kNeoHookean, kAveraged, true, true, true}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace incise
