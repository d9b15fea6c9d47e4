// The scene's structure: SOFA itself is not run here.
#include "interchange/specimens.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace incise {
namespace {

using testing::comments;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::numbers;
using testing::refused_field;
using testing::specimen;

class SofaScene : public ::testing::Test {
 protected:
  void load(const TissueModel& model) {
    testing::parse(sofa_scene_xml({model, Vec3(0, 0, testing::kGravity), "Test -- block", "by hand"}), document_);
    root_ = document_.child("Node");
    tissue_ = root_.child("Node");
  }
  [[nodiscard]] std::vector<double> of(const char* component, const char* attribute) const {
    return numbers(tissue_.child(component).attribute(attribute).value());
  }

  pugi::xml_document document_;
  pugi::xml_node root_;
  pugi::xml_node tissue_;
};

TEST_F(SofaScene, CoordinatesAndTetsReadBackExactlyInTheirOrder) {
  const TissueModel model = specimen();
  load(model);
  const std::vector<double> positions = of("TetrahedronSetTopologyContainer", "position");
  ASSERT_EQ(positions.size(), 3 * model.mesh.vertices.size());
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_EQ(positions[3 * v + i], model.mesh.vertices[v][static_cast<int>(i)]) << "vertex " << v;
  }
  const std::vector<double> tets = of("TetrahedronSetTopologyContainer", "tetrahedra");
  ASSERT_EQ(tets.size(), 4 * model.mesh.tets.size());
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(tets[4 * t + c], model.mesh.tets[t][c].value) << "tet " << t;
  }
}

TEST_F(SofaScene, HasTheLawMassAndGravityInMmKgS) {
  load(specimen());
  const pugi::xml_node law = tissue_.child("FastTetrahedralCorotationalForceField");
  EXPECT_STREQ(law.attribute("method").value(), "polar");
  EXPECT_EQ(law.attribute("youngModulus").as_double(), 70.0);
  EXPECT_EQ(law.attribute("poissonRatio").as_double(), 0.49);
  EXPECT_EQ(of("DiagonalMass", "massDensity"), std::vector<double>{1040e-9});
  EXPECT_EQ(numbers(root_.attribute("gravity").value()), (std::vector<double>{0, 0, -9810}));
  EXPECT_THAT(comments(document_), HasSubstr("mm, kg, s"));
}

TEST_F(SofaScene, HoldsEveryVertexThatTheModelHoldsAndNoOther) {
  const TissueModel model = specimen();
  load(model);
  std::vector<std::array<bool, 3>> held(model.mesh.vertices.size(), {false, false, false});
  const auto hold = [&](pugi::xml_node node, const std::vector<double>& axes) {
    for (const double index : numbers(node.attribute("indices").value())) {
      for (std::size_t i = 0; i < 3; ++i) held.at(static_cast<std::size_t>(index))[i] |= axes.at(i) != 0.0;
    }
  };
  for (pugi::xml_node node : tissue_.children("FixedProjectiveConstraint")) hold(node, {1, 1, 1});
  for (pugi::xml_node node : tissue_.children("LinearMovementProjectiveConstraint")) hold(node, {1, 1, 1});
  for (pugi::xml_node node : tissue_.children("PartialFixedProjectiveConstraint")) {
    hold(node, numbers(node.attribute("fixedDirections").value()));
  }
  EXPECT_EQ(held, model.is_fixed);
}

TEST_F(SofaScene, MovesToTheDisplacementAndStaysThere) {
  load(specimen());
  const std::vector<double> keys = of("LinearMovementProjectiveConstraint", "keyTimes");
  ASSERT_EQ(keys.size(), 3U);
  EXPECT_EQ(of("LinearMovementProjectiveConstraint", "movements"),
            (std::vector<double>{0, 0, 0, 1.5, -0.25, 0, 1.5, -0.25, 0}));
}

TEST_F(SofaScene, TractionsAndThePlatformAreTheModels) {
  const TissueModel model = specimen();
  load(model);
  const std::vector<double> indices = of("ConstantForceField", "indices");
  const std::vector<double> forces = of("ConstantForceField", "forces");
  ASSERT_EQ(forces.size(), 3 * indices.size());
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto v = static_cast<std::size_t>(indices[i]);
    const Vec3 force(forces[3 * i], forces[3 * i + 1], forces[3 * i + 2]);
    const Vec3 weight = model.vertex_mass_kg.at(v) * Vec3(0, 0, testing::kGravity);
    EXPECT_LT((force - (model.dead_load_mn[v] - weight)).norm(), 1e-12);
    sum += force;
  }
  EXPECT_LT((sum - model.applied_load_mn[4]).norm(), 1e-12);
  const pugi::xml_node plane = tissue_.child("PlaneForceField");
  EXPECT_EQ(numbers(plane.attribute("normal").value()), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(plane.attribute("d").as_double(), -0.7);
  EXPECT_GT(plane.attribute("stiffness").as_double(), 0.0);
}

TEST_F(SofaScene, AsksForAPluginForEachComponent) {
  load(specimen());
  std::set<std::string> plugins;
  for (pugi::xml_node node : root_.children("RequiredPlugin")) plugins.insert(node.attribute("name").value());
  for (const char* name :
       {"Sofa.Component.Constraint.Projective", "Sofa.Component.Mass", "Sofa.Component.MechanicalLoad",
        "Sofa.Component.ODESolver.Backward", "Sofa.Component.SolidMechanics.FEM.Elastic"}) {
    EXPECT_EQ(plugins.count(name), 1U) << name;
  }
}

TEST_F(SofaScene, AStiffnessThatVariesIsGivenTetByTet) {
  MaterialField field;
  field.youngs_modulus_kpa.assign(testing::odd_block().tets.size(), 70.0);
  field.youngs_modulus_kpa[5] = 700.0;
  load(specimen({}, testing::every_kind(), field));
  const std::vector<double> youngs = of("FastTetrahedralCorotationalForceField", "youngModulus");
  ASSERT_EQ(youngs.size(), field.youngs_modulus_kpa.size());
  for (std::size_t t = 0; t < youngs.size(); ++t)
    EXPECT_NEAR(youngs[t], field.youngs_modulus_kpa[t], 1e-9) << "tet " << t;
}

TEST_F(SofaScene, TheNeoHookeanLawAndWhatDiffersIsSaid) {
  Material material;
  material.model = MaterialModel::StableNeoHookean;
  material.volume = VolumeTreatment::Averaged;
  material.prony = {{0.5, 2.0}};
  const TissueModel model = specimen(material);
  load(model);
  const pugi::xml_node law = tissue_.child("TetrahedronHyperelasticityFEMForceField");
  EXPECT_STREQ(law.attribute("materialName").value(), "StableNeoHookean");
  EXPECT_EQ(numbers(law.attribute("ParameterSet").value()),
            (std::vector<double>{model.lame[0].mu_kpa, model.lame[0].lambda_kpa}));
  EXPECT_THAT(comments(document_), HasSubstr("averages the change of volume"));
  EXPECT_THAT(comments(document_), HasSubstr("viscosity is left out"));
  load(specimen());
  EXPECT_THAT(comments(document_), Not(HasSubstr("DIFFERS")));
}

TEST_F(SofaScene, WhatSofaCannotSayIsRefused) {
  const auto scene = [](const TissueModel& model) {
    return [&model] { return sofa_scene_xml({model, Vec3::Zero(), "", ""}); };
  };
  const TissueModel held = specimen({}, {FixedConstraint{testing::slab_x(0.1)}, testing::holder()});
  EXPECT_EQ(refused_field(scene(held)), "specimen.constraints[1].surface");
  Material fibrous{.fibre_modulus_kpa = 30.0};
  const TissueModel with_fibres = specimen(fibrous);
  EXPECT_EQ(refused_field(scene(with_fibres)), "specimen.material.fibre_modulus_kpa");
  Material neo{.model = MaterialModel::StableNeoHookean};
  MaterialField field;
  field.youngs_modulus_kpa.assign(held.mesh.tets.size(), 70.0);
  field.youngs_modulus_kpa[0] = 7.0;
  const TissueModel varied = specimen(neo, testing::every_kind(), field);
  EXPECT_EQ(refused_field(scene(varied)), "specimen.material.model");
  neo.stiffening = 0.469;
  const TissueModel stiffening = specimen(neo);
  EXPECT_EQ(refused_field(scene(stiffening)), "specimen.material.stiffening");
}

}  // namespace
}  // namespace incise
