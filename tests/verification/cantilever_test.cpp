// A beam that bends under its own weight, against Timoshenko's beam.
#include "mechanics/bodies.hpp"

#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::plane_x;

constexpr double kLength = 100.0;
constexpr double kHeight = 10.0;
constexpr double kYoungsModulus = 70.0;
constexpr double kGravity =
    -0.5;  // mm/s²: a tip displacement below 0.01 of the height, so that the linear beam applies

/// Tip displacement of a clamped beam of square section under its weight, ν = 0: bending w L⁴ / 8 E I and shear w L² /
/// 2 k G A, k = 5/6.
double beam_tip_mm(double density_kg_m3) {
  const double area = kHeight * kHeight;
  const double load = density_kg_m3 * 1e-9 * area * kGravity;  // mN/mm
  const double inertia = area * kHeight * kHeight / 12.0;
  const double shear_modulus = 0.5 * kYoungsModulus;
  return load * std::pow(kLength, 4) / (8.0 * kYoungsModulus * inertia) +
         load * kLength * kLength / (2.0 * 5.0 / 6.0 * shear_modulus * area);
}

double computed_tip_mm(int cells_across) {
  Material material;
  material.youngs_modulus_kpa = kYoungsModulus;
  material.poissons_ratio = 0.0;
  const TissueModel model =
      make_tissue_model(make_block(Vec3(kLength, kHeight, kHeight), {10 * cells_across, cells_across, cells_across}),
                        material, {FixedConstraint{plane_x(0.0)}}, Vec3(0, 0, kGravity));
  Workers workers(1);
  Monitor monitor;
  const StaticResult result = solve_static(model, {}, workers, monitor);
  EXPECT_EQ(result.outcome, Outcome::Success);
  double sum = 0.0;
  const auto tip = select(model.mesh, plane_x(kLength));
  for (const VertexId v : tip) sum += result.state.positions[v.index()][2] - model.mesh.vertices[v.index()][2];
  return sum / static_cast<double>(tip.size());
}

TEST(Cantilever, ApproachesTheBeamAtSecondOrder) {
  const double expected = beam_tip_mm(Material{}.density_kg_m3);
  const double coarse = 1.0 - computed_tip_mm(2) / expected;
  const double fine = 1.0 - computed_tip_mm(4) / expected;
  const double finer = 1.0 - computed_tip_mm(8) / expected;
  RecordProperty("error_2_4_8", std::to_string(coarse) + " " + std::to_string(fine) + " " + std::to_string(finer));
  EXPECT_GT(finer, 0.0) << "displacement elements are too stiff";
  EXPECT_LT(finer, 0.06);
  EXPECT_GT(std::log2(coarse / fine), 1.0);
  EXPECT_GT(std::log2(fine / finer), 1.6);
}

}  // namespace
}  // namespace incise
