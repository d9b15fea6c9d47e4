#include "mechanics/bodies.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/statics.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::irregular_block;
using ::testing::IsEmpty;
using testing::plane_x;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Vec3 centre(const TetMesh& mesh, const Tet& tet) {
  Vec3 sum = Vec3::Zero();
  for (const VertexId v : tet) sum += vertex(mesh.vertices, v);
  return 0.25 * sum;
}

/// The message of the InvalidArgument that a field is refused with.
std::string refusal(const TetMesh& mesh, const MaterialField& field) {
  return testing::refusal_of<InvalidArgument>(
      [&] { return make_tissue_model(mesh, Material{}, {FixedConstraint{plane_x(0.0)}}, Vec3::Zero(), field); });
}

/// A bar of which the half beyond x = 10 is ten times stiffer, pulled by 0.2 mm: springs in a row share 10 to 1.
TEST(MaterialField, MakesATumourTenTimesStiffer) {
  for (const auto law : {MaterialModel::Corotational, MaterialModel::StableNeoHookean}) {
    Material material{.model = law, .poissons_ratio = 0.0};
    TetMesh mesh = make_block(Vec3(20, 6, 6), {4, 1, 1});
    DataArray stiffness{1, {}};
    for (const Tet& tet : mesh.tets) stiffness.values.push_back(centre(mesh, tet)[0] > 10.0 ? 700.0 : 70.0);
    mesh.cell_data["youngs_modulus_kpa"] = stiffness;
    const MaterialField field = material_field_of(mesh);
    const double pull = 0.002;
    const TissueModel model = make_tissue_model(
        mesh, material, {FixedConstraint{plane_x(0.0)}, DisplacedConstraint{plane_x(20.0), Vec3(pull, 0, 0)}},
        Vec3::Zero(), field);
    const StaticResult result = testing::solve(model);
    ASSERT_EQ(result.outcome, Outcome::Success);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (mesh.vertices[v][0] != 10.0) continue;
      EXPECT_NEAR(result.state.positions[v][0] - 10.0, pull * 10.0 / 11.0, 1e-3 * pull);
    }
    const double force = pull * 36.0 / (10.0 / 70.0 + 10.0 / 700.0);  // mN
    EXPECT_NEAR(result.reactions_mn[1][0], force, 1e-3 * force);
  }
}

TEST(MaterialField, GivesEveryTetItsOwnPoissonsRatio) {
  const TetMesh mesh = make_block(Vec3(2, 1, 1), {2, 1, 1});
  MaterialField field;
  field.poissons_ratio.assign(mesh.tets.size(), 0.3);
  field.poissons_ratio[3] = 0.0;
  const TissueModel model = make_tissue_model(mesh, Material{}, {FixedConstraint{plane_x(0.0)}}, Vec3::Zero(), field);
  EXPECT_NEAR(model.lame[0].lambda_kpa, lame_parameters(70.0, 0.3).lambda_kpa, 1e-12);
  EXPECT_EQ(model.lame[3].lambda_kpa, 0.0);
}

/// Stretched along x, only those tets whose own fibres run along x are stressed by them.
TEST(MaterialField, GivesEveryTetItsOwnFibres) {
  const TetMesh mesh = irregular_block(Vec3(20, 12, 9), {2, 2, 2}, 0.2, 7);
  Material material{.fibre_modulus_kpa = 100.0};
  MaterialField field;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    field.fibre_directions.push_back(t % 2 == 0 ? Vec3(5, 0, 0) : Vec3(0, 0, 0.1));
  const TissueModel model = make_tissue_model(mesh, material, {FixedConstraint{plane_x(0.0)}}, Vec3::Zero(), field);
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p[0] *= 1.1;
  const std::vector<double> stress = von_mises_kpa(model, state);
  const double plain = 2.0 * model.lame[0].mu_kpa * 0.1;
  for (std::size_t t = 0; t < stress.size(); ++t) {
    EXPECT_NEAR(stress[t], plain + (t % 2 == 0 ? 10.0 : 0.0), 1e-9) << "tet " << t;
  }
}

TEST(MaterialField, OfAMeshWithoutDataIsEmpty) {
  const MaterialField field = material_field_of(make_block(Vec3(2, 1, 1), {2, 1, 1}));
  EXPECT_THAT(field.youngs_modulus_kpa, IsEmpty());
  EXPECT_THAT(field.poissons_ratio, IsEmpty());
  EXPECT_THAT(field.fibre_directions, IsEmpty());
}

TEST(MaterialField, NamesEveryViolation) {
  MaterialField field;
  field.youngs_modulus_kpa = {70.0, kNan, -1.0};
  field.poissons_ratio = {0.3, 0.3};
  field.fibre_directions = {Vec3::UnitX(), Vec3::UnitY(), Vec3::Zero()};
  EXPECT_THAT(sentences(validate(field, 3)),
              ElementsAre(AllOf(HasSubstr("youngs_modulus_kpa: found nan at tet 1"), HasSubstr("[1e-6, 1e9] kPa")),
                          HasSubstr("poissons_ratio: found 2 items, expected one for each of 3 tets"),
                          HasSubstr("fibre_direction: found [0, 0, 0] at tet 2")));
  field.poissons_ratio = {0.3, 0.5, kNan};
  EXPECT_THAT(sentence(validate(field, 3)[1]), HasSubstr("poissons_ratio: found 0.5 at tet 1"));
}

TEST(MaterialField, IsRefusedWithTheReasonWhenAModelIsMade) {
  const TetMesh mesh = make_block(Vec3(2, 1, 1), {2, 1, 1});
  MaterialField field{.youngs_modulus_kpa = {70.0}};
  EXPECT_THAT(refusal(mesh, field), HasSubstr("found 1 items, expected one for each of 12 tets"));
  field.youngs_modulus_kpa.assign(12, 70.0);
  EXPECT_EQ(refusal(mesh, field), "accepted");
  field.youngs_modulus_kpa[7] = kNan;
  EXPECT_THAT(refusal(mesh, field), HasSubstr("found nan at tet 7"));
}

TEST(MaterialField, RefusesCellDataOfTheWrongShape) {
  TetMesh mesh = make_block(Vec3(2, 1, 1), {2, 1, 1});
  mesh.cell_data["fibre_direction"] = {1, std::vector<double>(12, 1.0)};
  EXPECT_THROW(static_cast<void>(material_field_of(mesh)), InvalidArgument);
}

}  // namespace
}  // namespace incise
