// Homogeneous states, for which linear tetrahedra are exact on any mesh.
#include "mechanics/bodies.hpp"

#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::irregular_block;
using testing::plane_x;
using testing::plane_y;
using testing::plane_z;

constexpr double kSolverTolerance = 1e-8;  // relative to the displacement: Newton stops at 1e-10 of the reactions

const Vec3 kSize(60, 20, 10);

/// A bar between three planes of symmetry.
std::vector<Constraint> symmetry() {
  return {FixedConstraint{plane_x(0.0), {true, false, false}}, FixedConstraint{plane_y(0.0), {false, true, false}},
          FixedConstraint{plane_z(0.0), {false, false, true}}};
}

StaticResult solve(const TissueModel& model) {
  return testing::solve(model, {.relative_tolerance = 1e-10});
}

TEST(Bar, UnderUniaxialTractionStretchesByTractionOverYoungsModulus) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    for (const double traction : {0.07, 14.0, 35.0}) {  // strains of 0.1 %, 20 % and 50 %
      Material material{.poissons_ratio = nu};
      std::vector<Constraint> constraints = symmetry();
      constraints.emplace_back(TractionConstraint{plane_x(kSize[0]), Vec3(traction, 0, 0)});
      const TissueModel model = make_tissue_model(irregular_block(kSize, {8, 4, 3}, 0.2, 3), material, constraints);
      const StaticResult result = solve(model);
      ASSERT_EQ(result.outcome, Outcome::Success);
      // P = E (stretch - 1) along the bar, by the law's linearity in the stretches; the load is dead.
      const double strain = traction / material.youngs_modulus_kpa;
      for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
        const Vec3& rest = model.mesh.vertices[v];
        const Vec3 expected = rest + strain * rest.cwiseProduct(Vec3(1.0, -nu, -nu));
        ASSERT_LT((result.state.positions[v] - expected).norm(), kSolverTolerance * strain * kSize[0])
            << "nu " << nu << ", traction " << traction << ", vertex " << v;
      }
    }
  }
}

TEST(Bar, PatchOfPrescribedLinearDisplacementIsReproducedInside) {
  // The whole boundary is moved by a linear field, face by face; the inside has to follow it.
  const TetMesh mesh = irregular_block(kSize, {6, 4, 3}, 0.2, 5);
  TissueModel model = make_tissue_model(mesh, {}, symmetry());
  Mat3 f;
  f << 1.15, 0.1, 0.0, -0.05, 0.95, 0.1, 0.08, 0.0, 1.05;
  for (const BoundaryFace& face : boundary_faces(mesh)) {
    for (const VertexId v : face.corners) {
      model.is_fixed[v.index()] = {true, true, true};
      model.prescribed_displacement_mm[v.index()] = f * vertex(mesh.vertices, v) - vertex(mesh.vertices, v);
    }
  }
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    ASSERT_LT((result.state.positions[v] - f * mesh.vertices[v]).norm(), kSolverTolerance * kSize[0]) << "vertex " << v;
  }
}

}  // namespace
}  // namespace incise
