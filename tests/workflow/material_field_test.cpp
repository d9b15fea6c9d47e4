#include "support/refusal.hpp"

#include <incise/core/cache.hpp>
#include <incise/core/error.hpp>
#include <incise/workflow/study.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// 12 tets; labels 1 and, for the last three, 2.
TetMesh labelled_block() {
  TetMesh mesh = make_block(Vec3(20, 10, 10), {2, 1, 1});
  DataArray label{1, std::vector<double>(12, 1.0)};
  label.values[9] = label.values[10] = label.values[11] = 2.0;
  mesh.cell_data["label"] = label;
  return mesh;
}

std::string refusal(const TetMesh& mesh, const MaterialVariation& variation) {
  return testing::refusal_of<CaseError>([&] { return material_field(mesh, {}, variation); });
}

TEST(MaterialField, IsEmptyWhereNothingVaries) {
  const MaterialField field = material_field(labelled_block(), {}, {});
  EXPECT_THAT(field.youngs_modulus_kpa, IsEmpty());
  EXPECT_THAT(field.poissons_ratio, IsEmpty());
  EXPECT_THAT(field.fibre_directions, IsEmpty());
}

TEST(MaterialField, ALabelledPartIsTenTimesStiffer) {
  MaterialVariation variation{.labels = {{2, 700.0, std::nullopt}}};
  const MaterialField field = material_field(labelled_block(), {}, variation);
  ASSERT_EQ(field.youngs_modulus_kpa.size(), 12U);
  EXPECT_EQ(field.youngs_modulus_kpa[8], 70.0);
  EXPECT_EQ(field.youngs_modulus_kpa[9], 700.0);
  EXPECT_THAT(field.poissons_ratio, IsEmpty());
}

TEST(MaterialField, CellDataOfTheMeshHoldAndLabelsAreLaidOverThem) {
  TetMesh mesh = labelled_block();
  mesh.cell_data["youngs_modulus_kpa"] = {1, std::vector<double>(12, 30.0)};
  mesh.cell_data["fibre_direction"] = {3, std::vector<double>(36, 1.0)};
  MaterialVariation variation{.from_mesh = true, .labels = {{2, std::nullopt, 0.4}, {1, 50.0, std::nullopt}}};
  const MaterialField field = material_field(mesh, {}, variation);
  EXPECT_EQ(field.youngs_modulus_kpa[0], 50.0);
  EXPECT_EQ(field.youngs_modulus_kpa[11], 30.0);
  EXPECT_EQ(field.poissons_ratio[0], Material{}.poissons_ratio);
  EXPECT_EQ(field.poissons_ratio[11], 0.4);
  EXPECT_THAT(field.fibre_directions, Each(Vec3(1, 1, 1)));
}

TEST(MaterialField, SaysWhatTheMeshDoesNotCarry) {
  MaterialVariation from_mesh{.from_mesh = true};
  EXPECT_THAT(refusal(labelled_block(), from_mesh),
              AllOf(HasSubstr("specimen.material.from_mesh"), HasSubstr("'label'"), HasSubstr("fibre_direction")));
  MaterialVariation labels{.labels = {{2, 700.0, std::nullopt}}};
  EXPECT_THAT(refusal(make_block(Vec3(1, 1, 1), {1, 1, 1}), labels),
              AllOf(HasSubstr("specimen.material.labels"), HasSubstr("a mesh without cell data")));
  labels.labels = {{2, 700.0, std::nullopt}, {5, 7.0, std::nullopt}};
  EXPECT_THAT(refusal(labelled_block(), labels),
              AllOf(HasSubstr("specimen.material.labels[1].label"), HasSubstr("between 1 and 2")));
}

TEST(MaterialField, RefusesDirectionsOfFibresThatHaveNoStiffness) {
  TetMesh mesh = labelled_block();
  mesh.cell_data["fibre_direction"] = {3, std::vector<double>(36, 1.0)};
  MaterialVariation from_mesh{.from_mesh = true};
  EXPECT_THAT(refusal(mesh, from_mesh), AllOf(HasSubstr("specimen.material.fibre_modulus_kpa: found 0 kPa"), HasSubstr("above 0")));
  Material with_fibres{.fibre_modulus_kpa = 30.0};
  EXPECT_EQ(material_field(mesh, with_fibres, from_mesh).fibre_directions.size(), 12U);
}

/// Fibres from the end at x = 0 to that at x = 20.
MaterialVariation along_the_block() {
  MaterialVariation variation{
      .fibre_field = FibreField{EndRegion{-Vec3::UnitX(), 0.1}, EndRegion{Vec3::UnitX(), 0.1}}};
  return variation;
}

TEST(MaterialField, HasTheDirectionsOfItsFibreField) {
  Material fibrous{.fibre_modulus_kpa = 30.0};
  const MaterialField field = material_field(labelled_block(), fibrous, along_the_block());
  ASSERT_EQ(field.fibre_directions.size(), 12U);
  for (const Vec3& direction : field.fibre_directions) EXPECT_LT((direction - Vec3::UnitX()).norm(), 1e-8);
  EXPECT_THAT(field.youngs_modulus_kpa, IsEmpty());
}

TEST(MaterialField, RefusesAFibreFieldThatWouldNotActOrIsNotAlone) {
  EXPECT_THAT(refusal(labelled_block(), along_the_block()),
              AllOf(HasSubstr("specimen.material.fibre_modulus_kpa: found 0 kPa, with which fibre_field changes "
                              "nothing"),
                    HasSubstr("above 0")));
  EXPECT_EQ(validate(Material{}, along_the_block()).size(), 1U);
  Material fibrous{.fibre_modulus_kpa = 30.0};
  EXPECT_THAT(validate(fibrous, along_the_block()), IsEmpty());
  const auto refusal_of_fibrous = [&](const TetMesh& mesh, const MaterialVariation& variation) {
    return testing::refusal_of<CaseError>([&] { return material_field(mesh, fibrous, variation); });
  };
  TetMesh mesh = labelled_block();
  MaterialVariation both = along_the_block();
  both.from_mesh = true;
  mesh.cell_data["youngs_modulus_kpa"] = {1, std::vector<double>(12, 30.0)};
  EXPECT_EQ(refusal_of_fibrous(mesh, both), "accepted") << "from_mesh alone gives no directions";
  mesh.cell_data["fibre_direction"] = {3, std::vector<double>(36, 1.0)};
  EXPECT_THAT(refusal_of_fibrous(mesh, both), AllOf(HasSubstr("specimen.material.fibre_field: found fibre directions"),
                                                    HasSubstr("expected one of the two")));
  MaterialVariation beside = along_the_block();
  beside.fibre_field->to = PlaneRegion{Vec3(50, 0, 0), Vec3::UnitX(), std::nullopt};
  EXPECT_THAT(refusal_of_fibrous(labelled_block(), beside),
              HasSubstr("specimen.material.fibre_field.to: found a region without any vertex of the mesh"));
}

TEST(TissueOf, HasTheFibresOfTheCase) {
  Case settings;
  settings.constraints = std::vector<Constraint>{FixedConstraint{EndRegion{Vec3::UnitX(), 1.0}}};
  settings.material.fibre_modulus_kpa = 30.0;
  settings.material.fibre_stiffening = 4.0;
  settings.variation = along_the_block();
  const TissueModel model = tissue_of(settings, labelled_block());
  ASSERT_EQ(model.fibres.size(), 12U);
  for (const Vec3& fibre : model.fibres) EXPECT_LT((fibre - Vec3::UnitX()).norm(), 1e-8) << "in place of y";
}

/// The mesh for the cut is made round where a coarse one says that the cut lies: its fibres count, too.
TEST(MeshAroundPlannedCut, TakesTheFibreFieldOnItsSurveyMesh) {
  Case settings;
  settings.meshing.survey_mm = 8.0;
  settings.material.fibre_modulus_kpa = 30.0;
  settings.variation.fibre_field = {EndRegion{Vec3::UnitY(), 5.0},
                                    PlaneRegion{Vec3(0, -40, 0), -Vec3::UnitY(), std::nullopt}};
  GrayVolume occupancy;  // 24 x 44 x 10 mm
  occupancy.grid.size = {28, 48, 14};
  occupancy.grid.origin_mm = Vec3::Constant(-2.0);
  for (std::size_t v = 0; v < occupancy.grid.voxel_count(); ++v) {
    const auto [i, j, k] = occupancy.grid.voxel_at(v);
    const bool is_tissue = i >= 2 && i < 26 && j >= 2 && j < 46 && k >= 2 && k < 12;
    occupancy.voxels.push_back(is_tissue ? 1.0F : 0.0F);
  }
  Workers workers(1);
  Monitor silent;
  const auto error = testing::error_of<CaseError>(
      [&] { return mesh_around_planned_cut(settings, occupancy, std::nullopt, std::nullopt, workers, silent); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->field(), "specimen.material.fibre_field.to");
}

/// Stages are kept under a key of the settings.
TEST(MaterialVariation, ChangesTheKeyOfAStageByWhereItsFibresRun) {
  const auto key = [](const MaterialVariation& variation) { return CacheKey("mesh").add(variation).digest(); };
  const MaterialVariation along = along_the_block();
  MaterialVariation other = along;
  EXPECT_EQ(key(along), key(other));
  std::get<EndRegion>(other.fibre_field->to).within_mm = 0.2;
  EXPECT_NE(key(along), key(other));
  EXPECT_NE(key(along), key({}));
}

TEST(MaterialField, RefusesCellDataThatAreNoMaterial) {
  MaterialVariation from_mesh{.from_mesh = true};
  TetMesh mesh = labelled_block();
  mesh.cell_data["poissons_ratio"] = {1, std::vector<double>(12, 0.3)};
  mesh.cell_data["poissons_ratio"].values[4] = 0.5;
  EXPECT_THAT(refusal(mesh, from_mesh), AllOf(HasSubstr("from_mesh: found poissons_ratio of 0.5 at tet 4"), HasSubstr("[0, 0.5)")));
  mesh.cell_data["poissons_ratio"].values[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(mesh, from_mesh), HasSubstr("found poissons_ratio of nan at tet 4"));
  mesh.cell_data["poissons_ratio"] = {2, std::vector<double>(24, 0.3)};
  EXPECT_THAT(refusal(mesh, from_mesh), AllOf(HasSubstr("from_mesh: found 2, expected cell data \"poissons_ratio\" with 1 component"),
                                         Not(HasSubstr("operator"))));
  mesh.cell_data["label"] = {3, std::vector<double>(36, 1.0)};
  MaterialVariation labels{.labels = {{1, 700.0, std::nullopt}}};
  EXPECT_THAT(refusal(mesh, labels), AllOf(HasSubstr("'label' with 3 components"), HasSubstr("one number for each of 12 tets")));
}

TEST(TissueOf, TakesTheFieldAndTheConstraintsOfTheCase) {
  Case settings;
  settings.constraints = std::vector<Constraint>{FixedConstraint{EndRegion{Vec3::UnitX(), 1.0}}};
  settings.variation.labels = {{2, 700.0, std::nullopt}};
  const TissueModel model = tissue_of(settings, labelled_block());
  EXPECT_NEAR(model.lame[11].mu_kpa, 10.0 * model.lame[0].mu_kpa, 1e-9);
  EXPECT_EQ(model.constraints.size(), 1U);
  EXPECT_LT(model.dead_load_mn[0][2], 0.0) << "gravity";
}

/// What is said against a toughness that a mesh does not carry.
std::string toughness_refusal(const TetMesh& mesh, const ToughnessVariation& variation) {
  return testing::refusal_of<CaseError>([&] { return toughness_of(mesh, variation); });
}

TEST(Toughness, IsEmptyWhereNothingVaries) { EXPECT_THAT(toughness_of(labelled_block(), {}), IsEmpty()); }

TEST(Toughness, OfLabelsIsLaidOverThatOfTheMesh) {
  TetMesh mesh = labelled_block();
  mesh.cell_data["toughness"] = {1, std::vector<double>(12, 1.5)};
  const std::vector<double> toughness = toughness_of(mesh, {true, {{2, 4.0}}});
  ASSERT_EQ(toughness.size(), 12U);
  EXPECT_EQ(toughness[8], 1.5);
  EXPECT_EQ(toughness[9], 4.0);
  EXPECT_EQ(toughness_of(mesh, {false, {{2, 4.0}}})[8], 1.0);
}

TEST(Toughness, SaysWhatTheMeshDoesNotCarry) {
  EXPECT_THAT(toughness_refusal(labelled_block(), {true, {}}), AllOf(HasSubstr("cut.toughness_from_mesh"), HasSubstr("'toughness'")));
  EXPECT_THAT(toughness_refusal(make_block(Vec3(1, 1, 1), {1, 1, 1}), {false, {{2, 4.0}}}),
              AllOf(HasSubstr("cut.toughness"), HasSubstr("a mesh without cell data")));
  EXPECT_THAT(toughness_refusal(labelled_block(), {false, {{7, 4.0}}}), AllOf(HasSubstr("cut.toughness[0].label"), HasSubstr("between 1 and 2")));
}

TEST(Toughness, OfAMeshThatIsNoneIsRefusedNamingTheTet) {
  TetMesh mesh = labelled_block();
  mesh.cell_data["toughness"] = {1, std::vector<double>(12, 1.0)};
  mesh.cell_data["toughness"].values[3] = 0.0;
  EXPECT_THAT(toughness_refusal(mesh, {true, {}}), HasSubstr("found toughness of 0 at tet 3"));
  mesh.cell_data["toughness"].values[3] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(toughness_refusal(mesh, {true, {}}), HasSubstr("found toughness of inf at tet 3"));
  mesh.cell_data["toughness"].values.pop_back();
  EXPECT_THAT(toughness_refusal(mesh, {true, {}}), HasSubstr("11 numbers"));
}

TEST(Toughness, OfTheCaseIsThatOfTheTissue) {
  Case settings;
  settings.constraints = {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(21, 11, 0.1))}}};
  settings.toughness.labels = {{2, 4.0}};
  const TissueModel model = tissue_of(settings, labelled_block());
  ASSERT_EQ(model.toughness.size(), 12U);
  EXPECT_EQ(model.toughness[11], 4.0);
}

}  // namespace
}  // namespace incise
