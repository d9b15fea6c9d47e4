#include "mechanics/bodies.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/tissue.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace incise {
namespace {

using ::testing::AllOf;
using testing::clamped_block;
using testing::dense;
using testing::elastic_forces;
using ::testing::HasSubstr;
using testing::plane_x;
using testing::plane_y;
using testing::plane_z;

const Constraint kClamp = FixedConstraint{plane_x(0.0)};

TissueModel block(std::vector<Constraint> constraints, const Material& material = {},
                  const Vec3& gravity = Vec3::Zero()) {
  return make_tissue_model(make_block(Vec3(20, 10, 10), {2, 1, 1}), material, std::move(constraints), gravity);
}

/// The message and field of the CaseError that `make` throws.
template <class Make>
std::pair<std::string, std::string> refusal(const Make& make) {
  const auto error = testing::error_of<CaseError>(make);
  return error ? std::pair(error->field(), std::string(error->what()))
               : std::pair(std::string(), std::string("accepted"));
}

TEST(TissueModel, MassIsDensityTimesVolume) {
  const TissueModel model = block({kClamp});
  const double mass = std::accumulate(model.vertex_mass_kg.begin(), model.vertex_mass_kg.end(), 0.0);
  EXPECT_NEAR(mass, 1040e-9 * 2000.0, 1e-15);
  EXPECT_NEAR(std::accumulate(model.volumes_mm3.begin(), model.volumes_mm3.end(), 0.0), 2000.0, 1e-9);
}

TEST(TissueModel, GradientsReproduceLinearFunctions) {
  const TissueModel model = clamped_block();
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
    Mat3 f = Mat3::Zero();
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < 4; ++c) {
      f += vertex(model.mesh.vertices, model.mesh.tets[t][c]) * model.gradients[t][c].transpose();
      sum += model.gradients[t][c];
    }
    ASSERT_LT((f - Mat3::Identity()).norm(), 1e-12);
    ASSERT_LT(sum.norm(), 1e-14);
  }
}

TEST(TissueModel, GravityIsMassTimesAcceleration) {
  const TissueModel model = block({kClamp}, {}, Vec3(0, 0, -9810));
  Vec3 sum = Vec3::Zero();
  for (const Vec3& load : model.dead_load_mn) sum += load;
  EXPECT_NEAR(sum[2], -9810.0 * 1040e-9 * 2000.0, 1e-9);
}

TEST(TissueModel, TractionIsPressureTimesArea) {
  const TissueModel model = block({kClamp, TractionConstraint{plane_x(20.0), Vec3(3, 0, 1)}});
  Vec3 sum = Vec3::Zero();
  for (const Vec3& load : model.dead_load_mn) sum += load;
  EXPECT_LT((sum - Vec3(300, 0, 100)).norm(), 1e-10);
  EXPECT_LT((model.applied_load_mn[1] - Vec3(300, 0, 100)).norm(), 1e-10);
}

TEST(TissueModel, DisplacedAndFixedAxesAreRemembered) {
  const TissueModel model = block({kClamp, DisplacedConstraint{plane_x(20.0), Vec3(5, 0, 0)}});
  EXPECT_EQ(model.is_fixed[0], (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(model.is_fixed[1], (std::array<bool, 3>{false, false, false}));
  EXPECT_EQ(model.prescribed_displacement_mm[2], Vec3(5, 0, 0));
  EXPECT_EQ(model.holder[2][0], 1);
}

TEST(TissueModel, RefusesAnUnsoundMesh) {
  TetMesh mesh = make_block(Vec3(20, 10, 10), {2, 1, 1});
  mesh.vertices[3][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(make_tissue_model(mesh, {}, {kClamp})), InvalidArgument);
}

TEST(TissueModel, NamesTheMaterialFieldThatIsOutOfRange) {
  Material negative{.youngs_modulus_kpa = -1.0};
  EXPECT_EQ(refusal([&] { static_cast<void>(block({kClamp}, negative)); }).first,
            "specimen.material.youngs_modulus_kpa");
  Material incompressible{.poissons_ratio = 0.5};
  const auto [field, message] = refusal([&] { static_cast<void>(block({kClamp}, incompressible)); });
  EXPECT_EQ(field, "specimen.material.poissons_ratio");
  EXPECT_THAT(message, HasSubstr("found 0.5, expected a number in [0, 0.5)"));
}

TEST(TissueModel, NamesTheRegionThatSelectsNothingAndTheMeshsBox) {
  const auto [field, message] = refusal([] {
    static_cast<void>(block({kClamp, FixedConstraint{SphereRegion{Vec3(0, 0, 99), 1.0}}}));
  });
  EXPECT_EQ(field, "specimen.constraints[1].where");
  EXPECT_THAT(message, HasSubstr("[0, 0, 0] to [20, 10, 10] mm"));
}

TEST(TissueModel, NamesATractionWithoutABoundaryFace) {
  const auto traction = TractionConstraint{SphereRegion{Vec3::Zero(), 1.0}, Vec3(1, 0, 0)};
  const auto [field, message] = refusal([&] { static_cast<void>(block({kClamp, traction})); });
  EXPECT_EQ(field, "specimen.constraints[1].where");
  EXPECT_THAT(message, HasSubstr("boundary face"));
}

TEST(TissueModel, NamesTheAxisOnWhichTwoConstraintsContradict) {
  const auto [field, message] = refusal([] {
    static_cast<void>(block({kClamp, DisplacedConstraint{plane_y(0.0), Vec3(0, 2, 0)}}));
  });
  EXPECT_EQ(field, "specimen.constraints[1].where");
  EXPECT_THAT(message, AllOf(HasSubstr("moved by 2 mm along y"), HasSubstr("specimen.constraints[0]")));
}

TEST(TissueModel, AcceptsConstraintsThatOverlapAndAgree) {
  EXPECT_NO_THROW(static_cast<void>(block({kClamp, DisplacedConstraint{plane_y(0.0), Vec3::Zero()}})));
}

TEST(TissueModel, RefusesABodyThatCanStillMoveAsAWhole) {
  const auto line = FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(21, 1, 1))}};
  const auto [field, message] = refusal([&] { static_cast<void>(block({line})); });
  EXPECT_EQ(field, "specimen.constraints");
  EXPECT_THAT(message, HasSubstr("found 1 of the 6 rigid motions"));  // the turn about that line
}

TEST(TissueModel, AcceptsThreePlanesOfSymmetry) {
  EXPECT_NO_THROW(static_cast<void>(
      block({FixedConstraint{plane_x(0.0), {true, false, false}}, FixedConstraint{plane_y(0.0), {false, true, false}},
             FixedConstraint{plane_z(0.0), {false, false, true}}})));
}

TEST(TissueModel, DoesNotCountASupportAsHolding) {
  const auto [field, message] = refusal([] { static_cast<void>(block({SupportConstraint{}})); });
  EXPECT_EQ(field, "specimen.constraints");
  EXPECT_THAT(message, AllOf(HasSubstr("6 of the 6"), HasSubstr("only pushes")));
}

TEST(TissueModel, RefusesLoadsWhoseForceIsNotFiniteAndDisplacementsFarBeyondTheBody) {
  const auto traction = refusal([] {
    static_cast<void>(block({kClamp, TractionConstraint{plane_x(20.0), Vec3(1e308, 0, 0)}}));
  });
  EXPECT_EQ(traction.first, "specimen.constraints[1].traction_kpa");
  EXPECT_THAT(traction.second, HasSubstr("1e+308"));
  EXPECT_EQ(refusal([] {
              Material heavy{.youngs_modulus_kpa = 1e9, .density_kg_m3 = 1e9};
              static_cast<void>(block({kClamp}, heavy, Vec3(0, 0, -1e308)));
            }).first,
            "specimen.gravity_mm_s2");
  // The diagonal is 24.49 mm long.
  const auto moved = [](double by) {
    return refusal([&] { static_cast<void>(block({kClamp, DisplacedConstraint{plane_x(20.0), Vec3(by, 0, 0)}})); });
  };
  for (const double by : {1e300, 2500.0}) {
    EXPECT_EQ(moved(by).first, "specimen.constraints[1].displacement_mm") << by;
    EXPECT_THAT(moved(by).second, AllOf(HasSubstr("at most 2449.49 mm"), HasSubstr("diagonal"))) << by;
  }
  EXPECT_EQ(moved(2400.0).second, "accepted");
}

TEST(TissueModel, RefusesNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal([&] {
              static_cast<void>(block({DisplacedConstraint{plane_x(0.0), Vec3(nan, 0, 0)}}));
            }).first,
            "specimen.constraints[0].displacement_mm");
  EXPECT_EQ(refusal([&] {
              static_cast<void>(block({kClamp, SupportConstraint{Vec3::Zero(), Vec3::Zero()}}));
            }).first,
            "specimen.constraints[1].plane.normal");
  EXPECT_EQ(refusal([&] { static_cast<void>(block({kClamp}, {}, Vec3(0, nan, 0))); }).first, "specimen.gravity_mm_s2");
  EXPECT_EQ(refusal([&] {
              static_cast<void>(block({FixedConstraint{SphereRegion{Vec3(nan, 0, 0), 1.0}}}));
            }).first,
            "specimen.constraints[0].where");
}

TEST(Support, PushesVerticesBehindThePlaneAndNeverPulls) {
  const TissueModel model = block({kClamp, SupportConstraint{Vec3(0, 0, 0), Vec3(0, 0, 2)}});
  TissueState state = rest_state(model);
  state.positions[1][2] = -0.05;
  state.positions[2][2] = 0.05;
  Points forces(state.positions.size(), Vec3::Zero());
  BlockMatrix stiffness(model.pattern);
  add_support_response(model, state, forces, &stiffness);
  EXPECT_GT(forces[1][2], 0.0);
  EXPECT_EQ(forces[1].head<2>().norm(), 0.0);
  EXPECT_EQ(forces[2], Vec3::Zero());
  EXPECT_NEAR(stiffness.block(model.pattern->diagonal[1])[8], forces[1][2] / 0.05, 1e-9);
  EXPECT_NEAR(support_energy_uj(model, state), 0.5 * forces[1][2] * 0.05, 1e-9);
  EXPECT_NEAR(support_penetration_mm(model, state), 0.05, 1e-15);
}

TEST(Support, RefusesAMatrixOfAnotherPattern) {
  const std::vector<Constraint> constraints{kClamp, SupportConstraint{Vec3(0, 0, 0), Vec3(0, 0, 2)}};
  const TissueModel model = block(constraints), other = block(constraints);
  const TissueState state = rest_state(model);
  Points forces(state.positions.size(), Vec3::Zero());
  BlockMatrix matrix(other.pattern);
  EXPECT_THROW(add_support_response(model, state, forces, &matrix), InvalidArgument);
}

TEST(HoldConstrained, MakesIdentityRowsAndKeepsSymmetry) {
  const TissueModel model = clamped_block({2, 2, 2});
  TissueState state = rest_state(model);
  BlockMatrix matrix(model.pattern);
  elastic_forces(model, state, &matrix);
  Points right(model.mesh.vertices.size(), Vec3::Ones());
  std::vector<std::uint8_t> also(right.size(), 0);
  also[26] = 1;
  hold_constrained(model, matrix, right, also);
  const Eigen::MatrixXd k = dense(matrix);
  EXPECT_EQ((k - k.transpose()).norm(), 0.0);
  for (const Eigen::Index v : {Eigen::Index{0}, Eigen::Index{3}, Eigen::Index{26}}) {
    for (Eigen::Index i = 3 * v; i < 3 * v + 3; ++i) {
      EXPECT_EQ(k(i, i), 1.0);
      EXPECT_EQ(k.row(i).squaredNorm(), 1.0);
      EXPECT_EQ(right[static_cast<std::size_t>(v)][static_cast<int>(i - 3 * v)], 0.0);
    }
  }
  EXPECT_EQ(right[1], Vec3::Ones());
}

TEST(HoldConstrained, HoldsVerticesOnWhichNothingPulls) {
  const TissueModel model = clamped_block({2, 2, 2});
  BlockMatrix matrix(model.pattern);
  Points right(model.mesh.vertices.size(), Vec3::Ones());
  hold_constrained(model, matrix, right);
  EXPECT_EQ((dense(matrix) - Eigen::MatrixXd::Identity(81, 81)).norm(), 0.0);
}

}  // namespace
}  // namespace incise
