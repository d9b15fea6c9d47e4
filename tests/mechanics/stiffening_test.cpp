// Tissue that stiffens as it is stretched: fibres and the substance between them, against their closed forms.
#include "mechanics/bodies.hpp"

#include <incise/mechanics/statics.hpp>
#include <incise/mechanics/tissue.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using testing::dense;
using testing::elastic_forces;
using testing::irregular_block;
using testing::norm;
using testing::plane_x;

const Vec3 kBarMm(6, 5, 4);

/// A bar in a uniform state of stretch.
class StretchedBar {
 public:
  explicit StretchedBar(const Material& material)
      : model_(make_tissue_model(irregular_block(kBarMm, {2, 2, 2}, 0.2, 3), material, {FixedConstraint{plane_x(0.0)}},
                                 Vec3::Zero())) {}

  /// First Piola stress along the axes, from the virial of the forces: Σ X fᵀ = −V P.
  [[nodiscard]] Vec3 stress_kpa(const Vec3& stretch) const {
    TissueState state = at(stretch);
    const Points forces = elastic_forces(model_, state);
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < forces.size(); ++v) sum -= model_.mesh.vertices[v].cwiseProduct(forces[v]);
    return sum / kBarMm.prod();
  }
  [[nodiscard]] double energy_kpa(const Vec3& stretch) const {
    return elastic_energy_uj(model_, at(stretch)) / kBarMm.prod();
  }
  /// Stress along x with free sides.
  [[nodiscard]] double uniaxial_stress_kpa(double along) const {
    double low = 0.3, high = 1.2;
    for (int i = 0; i < 60; ++i) {
      const double side = 0.5 * (low + high);
      (stress_kpa(Vec3(along, side, side))[1] < 0.0 ? low : high) = side;
    }
    return stress_kpa(Vec3(along, low, low))[0];
  }
  [[nodiscard]] const TissueModel& model() const { return model_; }
  [[nodiscard]] TissueState at(const Vec3& stretch) const {
    TissueState state = rest_state(model_);
    for (Vec3& p : state.positions) p = p.cwiseProduct(stretch);
    return state;
  }

 private:
  TissueModel model_;
};

/// Fibres along x in a law that is E e along each axis.
Material fibrous(double fibre_stiffening) {
  Material material;
  material.youngs_modulus_kpa = 2.0;
  material.poissons_ratio = 0.0;
  material.fibre_modulus_kpa = 120.0;
  material.fibre_stiffening = fibre_stiffening;
  material.fibre_direction = Vec3::UnitX();
  return material;
}

TEST(StiffeningFibres, PullAsTheirClosedFormSaysUpToTheLimitOfTheExponentAndBeyond) {
  constexpr double kStiffening = 8.0, kMostExponent = 5.0;
  const Material material = fibrous(kStiffening);
  const StretchedBar bar(material);
  const double limit = std::sqrt(kMostExponent / kStiffening);  // 0.79
  const double limit_force = limit * std::exp(kMostExponent);
  const double limit_slope = std::exp(kMostExponent) * (1.0 + 2.0 * kMostExponent);
  for (const double e : {-0.6, -0.1, 0.0, 0.05, 0.3, 0.6, 0.79, 0.8, 1.5, 4.0}) {
    double force = e, energy = 0.5 * e * e;  // of E_f
    if (e > 0.0 && e <= limit) {
      force = e * std::exp(kStiffening * e * e);
      energy = (std::exp(kStiffening * e * e) - 1.0) / (2.0 * kStiffening);
    } else if (e > limit) {
      force = limit_force + limit_slope * (e - limit);
      energy = (std::exp(kMostExponent) - 1.0) / (2.0 * kStiffening) + limit_force * (e - limit) +
               0.5 * limit_slope * (e - limit) * (e - limit);
    }
    const double expected = material.youngs_modulus_kpa * e + material.fibre_modulus_kpa * force;
    EXPECT_NEAR(bar.stress_kpa(Vec3(1.0 + e, 1, 1))[0], expected, 1e-11 * std::max(1.0, std::abs(expected))) << e;
    const double expected_energy = 0.5 * material.youngs_modulus_kpa * e * e + material.fibre_modulus_kpa * energy;
    EXPECT_NEAR(bar.energy_kpa(Vec3(1.0 + e, 1, 1)), expected_energy, 1e-11 * std::max(1.0, expected_energy)) << e;
  }
}

TEST(StiffeningFibres, AreSmoothAtRestAndAtTheLimit) {
  const Material material = fibrous(8.0);
  const StretchedBar bar(material);
  constexpr double kNear = 1e-5;
  const auto slope = [&](double from, double to) {
    return (bar.stress_kpa(Vec3(to, 1, 1))[0] - bar.stress_kpa(Vec3(from, 1, 1))[0]) / (to - from);
  };
  const double rest = material.youngs_modulus_kpa + material.fibre_modulus_kpa;
  EXPECT_NEAR(slope(1.0 - kNear, 1.0), rest, 1e-7 * rest);
  EXPECT_NEAR(slope(1.0, 1.0 + kNear), rest, 1e-7 * rest);
  const double limit = 1.0 + std::sqrt(5.0 / 8.0);
  const double below = slope(limit - kNear, limit), above = slope(limit, limit + kNear);
  EXPECT_NEAR(below, above, 1e-3 * above) << "the second derivative of the force jumps, not the first";
  EXPECT_GT(above, 1000.0 * rest);
}

TEST(StiffeningFibres, TendToLinearOnes) {
  const Vec3 stretch(1.4, 0.9, 1.1);
  const double linear = StretchedBar(fibrous(0.0)).stress_kpa(stretch)[0];
  EXPECT_NEAR(linear, 2.0 * 0.4 + 120.0 * 0.4, 1e-11);
  for (const double small : {1e-3, 1e-6, 1e-300}) {
    EXPECT_NEAR(StretchedBar(fibrous(small)).stress_kpa(stretch)[0] / linear - 1.0, 0.16 * small * 120.0 / 122.0,
                0.02 * small * small + 1e-13);
  }
}

TEST(StiffeningFibres, AreSoftInCompression) {
  const Vec3 shortened(0.7, 1, 1);
  EXPECT_EQ(StretchedBar(fibrous(8.0)).stress_kpa(shortened), StretchedBar(fibrous(0.0)).stress_kpa(shortened));
}

/// [Buchaillard2009]: c10 = 1.037 kPa, c20 = 0.486 kPa.
Material tongue(double stiffening) {
  Material material;
  material.model = MaterialModel::StableNeoHookean;
  material.poissons_ratio = 0.49;
  material.youngs_modulus_kpa = 6.0 * 1.037;
  material.stiffening = stiffening;
  return material;
}

struct YeohPoint {
  double stretch;
  double most_deviation;  ///< of the stress, from Yeoh's incompressible law with the same Young's modulus
};
class YeohBar : public ::testing::TestWithParam<YeohPoint> {};

// What docs/models/elasticity.md states.
TEST_P(YeohBar, DeviatesFromYeohsLawByAFewPerCent) {
  constexpr double kC10 = 1.037, kC20 = 0.486;
  const double s = GetParam().stretch;
  const double i1 = s * s + 2.0 / s;
  const double yeoh = 2.0 * (s - 1.0 / (s * s)) * (kC10 + 2.0 * kC20 * (i1 - 3.0));
  const double found = StretchedBar(tongue(kC20 / kC10)).uniaxial_stress_kpa(s);
  RecordProperty("deviation", std::to_string(found / yeoh - 1.0));
  EXPECT_LT(std::abs(found / yeoh - 1.0), GetParam().most_deviation) << found << " kPa, Yeoh " << yeoh << " kPa";
  const double unstiffened = StretchedBar(tongue(0.0)).uniaxial_stress_kpa(s);
  EXPECT_GT(std::abs(unstiffened / yeoh - 1.0), std::abs(found / yeoh - 1.0)) << "nearer than without the stiffening";
}
INSTANTIATE_TEST_SUITE_P(Stretches, YeohBar,
                         ::testing::Values(YeohPoint{1.1, 0.01}, YeohPoint{1.3, 0.03}, YeohPoint{1.5, 0.05}));

TEST(StiffeningTissue, StaysHookeanAtSmallStrain) {
  constexpr double kStrain = 1e-5;
  const double young = tongue(0.469).youngs_modulus_kpa;
  EXPECT_NEAR(StretchedBar(tongue(0.469)).uniaxial_stress_kpa(1.0 + kStrain) / (young * kStrain), 1.0, 1e-4);
}

TEST(StiffeningTissue, FindsItsEquilibriumWhenItIsPulled) {
  const auto pulled_energy_uj = [](double stiffening, double fibre_stiffening) {
    Material material = tongue(stiffening);
    material.fibre_modulus_kpa = 5.0;
    material.fibre_stiffening = fibre_stiffening;
    material.fibre_direction = Vec3(2, 1, 0);
    const TissueModel model = make_tissue_model(
        irregular_block(kBarMm, {4, 4, 4}, 0.2, 3), material,
        {FixedConstraint{plane_x(0.0)}, DisplacedConstraint{plane_x(kBarMm.x()), Vec3(0.5 * kBarMm.x(), 0, 0)}},
        Vec3::Zero());
    const StaticResult result = testing::solve(model);
    EXPECT_EQ(result.outcome, Outcome::Success) << stiffening << ", " << fibre_stiffening;
    return elastic_energy_uj(model, result.state);
  };
  const double linear = pulled_energy_uj(0.0, 0.0);
  EXPECT_GT(pulled_energy_uj(0.469, 0.0), 1.1 * linear);
  EXPECT_GT(pulled_energy_uj(0.0, 8.0), 1.1 * linear);
  EXPECT_GT(pulled_energy_uj(0.469, 8.0), 1.2 * linear);
}

TEST(StiffeningTissue, IsFiniteForTheLargestDeformationsOfItsLaw) {
  Material material = tongue(kStiffeningLimits.most);
  material.fibre_modulus_kpa = 100.0;
  material.fibre_stiffening = kFibreStiffeningLimits.most;
  const StretchedBar bar(material);
  for (const Vec3& stretch : {Vec3(1e50, 1e50, 1e50), Vec3(-1e50, 1e50, 1e50), Vec3(1e50, 1e-50, 0)}) {
    TissueState state = bar.at(stretch);
    BlockMatrix stiffness(bar.model().pattern);
    Points forces(state.positions.size(), Vec3::Zero());
    Workers workers(1);
    for (const Tangent tangent : {Tangent::Exact, Tangent::Projected}) {
      add_elastic_response(bar.model(), state, forces, &stiffness, workers, tangent);
      EXPECT_TRUE(dense(stiffness).allFinite()) << stretch.transpose();
    }
    for (const Vec3& force : forces) EXPECT_TRUE(force.allFinite()) << stretch.transpose();
    EXPECT_TRUE(std::isfinite(elastic_energy_uj(bar.model(), state))) << stretch.transpose();
  }
}

}  // namespace
}  // namespace incise
