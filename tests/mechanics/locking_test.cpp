#include "mechanics/bodies.hpp"

#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::plane_x;

constexpr double kTraction = 1e-3;  // kPa: small strain

/// Cook's membrane (48 x 44 to 16 mm, plane strain, n x n x 1 cells) at ν = 0.49: rise of its upper right corner, mm
/// per kPa of shear on the right edge.
double rise_of_cooks_membrane(MaterialModel law, VolumeTreatment volume, int n) {
  TetMesh mesh = make_block(Vec3::Ones(), {n, n, 1});
  for (Vec3& p : mesh.vertices) p = Vec3(48.0 * p[0], 44.0 * p[0] + p[1] * (44.0 - 28.0 * p[0]), 48.0 / n * p[2]);
  Material material{.model = law, .volume = volume};
  const Region everywhere = BoxRegion{bounding_box(mesh.vertices)};
  const TissueModel model =
      make_tissue_model(std::move(mesh), material,
                        {FixedConstraint{plane_x(0.0)}, FixedConstraint{everywhere, {false, false, true}},
                         TractionConstraint{plane_x(48.0), Vec3(0, kTraction, 0)}});
  const StaticResult result = testing::solve(model);
  EXPECT_EQ(result.outcome, Outcome::Success);
  const std::vector<VertexId> corner = select(model.mesh, SphereRegion{Vec3(48, 60, 0), 1e-6});
  EXPECT_EQ(corner.size(), 1U);
  return (result.state.positions[corner.front().index()][1] - 60.0) / kTraction;
}

/// The reference is the limit of the averaged treatment itself, extrapolated from three meshes (Aitken).
TEST(AveragedVolume, IsRightWhereTheStandardTetLocks) {
  for (const MaterialModel law : {MaterialModel::Corotational, MaterialModel::StableNeoHookean}) {
    const double coarse = rise_of_cooks_membrane(law, VolumeTreatment::Averaged, 11);
    const double middle = rise_of_cooks_membrane(law, VolumeTreatment::Averaged, 22);
    const double fine = rise_of_cooks_membrane(law, VolumeTreatment::Averaged, 44);
    const double limit = fine + (fine - middle) * (fine - middle) / ((middle - coarse) - (fine - middle));
    EXPECT_NEAR(fine, limit, 0.03 * limit);
    EXPECT_LT(rise_of_cooks_membrane(law, VolumeTreatment::PerTet, 44), 0.85 * limit);
  }
}

}  // namespace
}  // namespace incise
