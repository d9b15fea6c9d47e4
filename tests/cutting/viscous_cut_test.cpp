// Tissue that relaxes while it is cut: limits in which the answer is that of an elastic tissue.
#include "cutting/ring_in_a_block.hpp"

#include <incise/core/error.hpp>

#include <optional>

namespace incise {
namespace {

class ViscousCut : public testing::RingInABlock {
 protected:
  static constexpr int kCells = 16;  // across: coarse, for many cuts
  ViscousCut() : RingInABlock(kCells) {
    settings_.cut.bond_stiffness_kpa_mm2 = 300.0;
    settings_.cut.dullness = 6.0;
    settings_.cut.advance_per_step_mm = 0.4;
  }

  [[nodiscard]] TissueModel block(const Material& material) const {
    return make_tissue_model(make_block({32, 32, 8}, {kCells, kCells, kCells / 4}), material,
                             {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
  }
  static Material soft() {
    Material material{.youngs_modulus_kpa = 12.0, .poissons_ratio = 0.3};
    return material;
  }

  /// How far inwards the mid-line of the cut lies.
  [[nodiscard]] double drift_mm(const Material& material) {
    model_ = block(material);
    const IncisionResult result = cut(ring(4.0));
    EXPECT_EQ(result.unconverged_steps, 0U);
    EXPECT_TRUE(result.centerline.has_value());
    return result.centerline ? kRadiusMm - mean_radius(*result.centerline) : 0.0;
  }
};

TEST_F(ViscousCut, OfBranchesThatRelaxAtOnceIsThatOfElasticTissue) {
  Material material = soft();
  const double elastic_mm = drift_mm(material);
  EXPECT_GT(elastic_mm, 0.3) << "there is something to tell apart";
  material.prony = {{1e-12, 1e9}};  // hardly there, so elastic; assembled in each step as the other one is
  const double without_branch_mm = drift_mm(material);
  material.prony = {{1.5, 1e-6}};
  EXPECT_NEAR(drift_mm(material), without_branch_mm, 1e-6);
  EXPECT_NEAR(without_branch_mm, elastic_mm, 0.05) << "whose matrix may be a few steps old";
}

// Branches that never relax, unstrained when the cut begins, add their shear modulus to that of the tissue.
TEST_F(ViscousCut, OfBranchesThatNeverRelaxIsThatOfStifferTissue) {
  Material material = soft();
  const double soft_mm = drift_mm(material);
  material.prony = {{2.0, 1e9}};
  const double viscous_mm = drift_mm(material);
  Material stiff = soft();  // three times μ at the same λ
  const double mu = 12.0 / (2.0 * 1.3), lambda = 12.0 * 0.3 / (1.3 * 0.4);
  stiff.youngs_modulus_kpa = 3.0 * mu * (3.0 * lambda + 6.0 * mu) / (lambda + 3.0 * mu);
  stiff.poissons_ratio = lambda / (2.0 * (lambda + 3.0 * mu));
  const double stiff_mm = drift_mm(stiff);
  EXPECT_LT(stiff_mm, 0.9 * soft_mm) << "there is something to tell apart";
  // At the strains round the tool, a few tenths, Green and Lagrange's law is stiffer than the corotational one.
  EXPECT_LT(viscous_mm, 0.5 * (soft_mm + stiff_mm));
  EXPECT_GT(viscous_mm, 0.85 * stiff_mm);
}

TEST_F(ViscousCut, GoesByTheRealToolsPace) {
  Material material = soft();
  material.prony = {{2.0, 2.0}};
  settings_.cut.power_exponent = 0.0;  // the pace alone, not the energy that goes with it
  settings_.cut.real_speed_mm_s = 100.0;
  const double fast_mm = drift_mm(material);
  settings_.cut.real_speed_mm_s = 0.1;
  const double slow_mm = drift_mm(material);
  EXPECT_GT(slow_mm, fast_mm + 0.1) << "the slower tool meets tissue that has relaxed, and drags it farther";
}

TEST_F(ViscousCut, BeginsWithWhatTheStretchHasLeftInTheBranches) {
  Material material = soft();
  material.prony = {{2.0, 100.0}};
  const TissueModel model = block(material);
  TissueState stretched = rest_state(model);
  for (Vec3& place : stretched.positions) place.x() *= 1.2;
  const auto memory_after = [&](std::optional<double> since_s) {
    settings_.time_since_stretch_s = since_s;
    return begin_incision(model, stretched, ring(4.0), settings_).state.tissue.memory;
  };
  const double strain = (1.2 * 1.2 - 1.0) / 2.0 * 2.0 / 3.0;  // the deviator's first component
  EXPECT_NEAR(memory_after({}).strains[7](0, 0), strain, 1e-12);
  EXPECT_EQ(memory_after({}).branches[7], Mat3::Zero());
  EXPECT_NEAR(memory_after(0.0).branches[7](0, 0), strain, 1e-12);
  EXPECT_NEAR(memory_after(100.0).branches[7](0, 0), std::exp(-1.0) * strain, 1e-12);
  settings_.time_since_stretch_s = -1.0;
  EXPECT_THROW(static_cast<void>(begin_incision(model, stretched, ring(4.0), settings_)), InvalidArgument);
}

TEST_F(ViscousCut, HasTheSameBitsWithAnyThreads) {
  Material material = soft();
  material.prony = {{1.5, 0.5}};
  material.kelvin_voigt_time_s = 0.01;
  model_ = block(material);
  const auto positions_with = [&](int threads) {
    Workers workers(threads);
    Monitor silent;
    return simulate_incision(model_, rest_state(model_), ring(4.0), settings_, workers, silent)
        .final_state.tissue.positions;
  };
  EXPECT_EQ(positions_with(1), positions_with(2));
}

}  // namespace
}  // namespace incise
