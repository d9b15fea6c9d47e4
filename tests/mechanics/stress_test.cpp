#include "mechanics/bodies.hpp"

#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::irregular_block;
using testing::plane_x;
using testing::some_rotation;

const Vec3 kStressedMm(20, 12, 9);

TissueModel stressed_block(const Material& material) {
  return make_tissue_model(irregular_block(kStressedMm, {2, 2, 2}, 0.2, 7), material, {FixedConstraint{plane_x(0.0)}});
}

TissueState mapped(const TissueModel& model, const Mat3& f) {
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p = f * p;
  return state;
}

/// Von Mises stress of a homogeneous triaxial stretch, from the energy alone: σ_i = s_i ∂ψ/∂s_i / J (hyperelastic) or
/// ∂ψ/∂s_i (corotational, small strain measure).
double by_energy(const TissueModel& model, const Vec3& stretch) {
  Vec3 sigma;
  for (int i = 0; i < 3; ++i) {
    const auto density = [&](double change) {
      Vec3 s = stretch;
      s[i] += change;
      return elastic_energy_uj(model, mapped(model, s.asDiagonal())) / kStressedMm.prod();
    };
    sigma[i] = (density(1e-5) - density(-1e-5)) / 2e-5;
    if (model.material.model == MaterialModel::StableNeoHookean) sigma[i] *= stretch[i] / stretch.prod();
  }
  return std::sqrt(
      0.5 * (std::pow(sigma[0] - sigma[1], 2) + std::pow(sigma[1] - sigma[2], 2) + std::pow(sigma[2] - sigma[0], 2)));
}

TEST(VonMises, FollowsFromTheEnergyForEveryLaw) {
  for (const auto law : {MaterialModel::Corotational, MaterialModel::StableNeoHookean}) {
    for (const auto volume : {VolumeTreatment::PerTet, VolumeTreatment::Averaged}) {
      for (const double fibre_modulus : {0.0, 50.0}) {
        Material material{.model = law, .volume = volume, .fibre_modulus_kpa = fibre_modulus};
        material.fibre_direction = Vec3::UnitX();  // a principal direction: the stress has no shear
        const TissueModel model = stressed_block(material);
        const Vec3 stretch(1.3, 0.85, 0.95);
        const TissueState state = mapped(model, some_rotation() * stretch.asDiagonal());
        const double expected = by_energy(model, stretch);
        for (const double found : von_mises_kpa(model, state)) EXPECT_NEAR(found, expected, 1e-6 * expected);
      }
    }
  }
}

TEST(VonMises, IsZeroUnderPressureAlone) {
  Material material{.model = MaterialModel::StableNeoHookean};
  const TissueModel model = stressed_block(material);
  for (const double found : von_mises_kpa(model, mapped(model, 0.9 * some_rotation()))) EXPECT_LT(found, 1e-10);
}

}  // namespace
}  // namespace incise
