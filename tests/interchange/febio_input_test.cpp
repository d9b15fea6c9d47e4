// The input's structure: FEBio itself is not run here.
#include "interchange/specimens.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace incise {
namespace {

using testing::comments;
using ::testing::HasSubstr;
using testing::numbers;
using testing::refused_field;
using testing::specimen;

class FebioInput : public ::testing::Test {
 protected:
  void load(const TissueModel& model) {
    testing::parse(febio_input_xml({model, Vec3(0, 0, testing::kGravity), "Test block", "by hand"}), document_);
    root_ = document_.child("febio_spec");
    mesh_ = root_.child("Mesh");
  }
  [[nodiscard]] std::vector<double> node_set(const std::string& name) const {
    return numbers(mesh_.find_child_by_attribute("NodeSet", "name", name.c_str()).text().get());
  }

  pugi::xml_document document_;
  pugi::xml_node root_;
  pugi::xml_node mesh_;
};

TEST_F(FebioInput, CoordinatesAndTetsReadBackExactlyInTheirOrderFrom1) {
  const TissueModel model = specimen();
  load(model);
  std::size_t v = 0;
  for (pugi::xml_node node : mesh_.child("Nodes").children("node")) {
    ASSERT_EQ(node.attribute("id").as_uint(), v + 1);
    const std::vector<double> p = numbers(node.text().get());
    ASSERT_EQ(p.size(), 3U);
    ASSERT_EQ(Vec3(p[0], p[1], p[2]), model.mesh.vertices.at(v)) << "vertex " << v;
    ++v;
  }
  EXPECT_EQ(v, model.mesh.vertices.size());
  std::size_t t = 0;
  const pugi::xml_node elements = mesh_.child("Elements");
  EXPECT_STREQ(elements.attribute("type").value(), "tet4");
  for (pugi::xml_node element : elements.children("elem")) {
    ASSERT_EQ(element.attribute("id").as_uint(), t + 1);
    const std::vector<double> corners = numbers(element.text().get());
    ASSERT_EQ(corners.size(), 4U);
    for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(corners[c], model.mesh.tets.at(t)[c].value + 1) << "tet " << t;
    ++t;
  }
  EXPECT_EQ(t, model.mesh.tets.size());
}

TEST_F(FebioInput, EveryNameAndNumberThatIsUsedExists) {
  load(specimen());
  std::set<double> nodes;
  std::set<double> elements;
  std::map<std::string, std::size_t> sets;  // name -> items
  std::set<std::string> surfaces;
  std::set<std::string> parts;
  std::set<std::string> materials;
  std::set<std::string> maps;
  for (pugi::xml_node group : mesh_.children("Nodes")) {
    for (pugi::xml_node node : group)
      EXPECT_TRUE(nodes.insert(node.attribute("id").as_double()).second) << "node twice";
  }
  const auto require_nodes = [&](pugi::xml_node item) {
    for (const double n : numbers(item.text().get()))
      ASSERT_EQ(nodes.count(n), 1U) << item.name() << " names node " << n;
  };
  for (pugi::xml_node group : mesh_.children("Elements")) {
    parts.insert(group.attribute("name").value());
    for (pugi::xml_node element : group) {
      EXPECT_TRUE(elements.insert(element.attribute("id").as_double()).second) << "element twice";
      require_nodes(element);
    }
  }
  for (pugi::xml_node set : mesh_.children("NodeSet")) {
    EXPECT_TRUE(sets.emplace(set.attribute("name").value(), numbers(set.text().get()).size()).second) << "set twice";
    require_nodes(set);
  }
  for (pugi::xml_node surface : mesh_.children("Surface")) {
    surfaces.insert(surface.attribute("name").value());
    for (pugi::xml_node triangle : surface) require_nodes(triangle);
  }
  std::set<std::string> pairs;
  for (pugi::xml_node pair : mesh_.children("SurfacePair")) {
    pairs.insert(pair.attribute("name").value());
    EXPECT_EQ(surfaces.count(pair.child_value("primary")), 1U);
    EXPECT_EQ(surfaces.count(pair.child_value("secondary")), 1U);
  }
  for (pugi::xml_node material : root_.child("Material")) materials.insert(material.attribute("name").value());
  std::set<std::string> used_parts;
  for (pugi::xml_node domain : root_.child("MeshDomains")) {
    used_parts.insert(domain.attribute("name").value());
    EXPECT_EQ(materials.count(domain.attribute("mat").value()), 1U) << domain.attribute("mat").value();
  }
  EXPECT_EQ(used_parts, parts) << "every part has a material";
  for (pugi::xml_node data : root_.child("MeshData").children("NodeData")) {
    maps.insert(data.attribute("name").value());
    const auto items = static_cast<std::size_t>(std::distance(data.begin(), data.end()));
    EXPECT_EQ(items, sets.at(data.attribute("node_set").value())) << data.attribute("name").value();
  }
  for (pugi::xml_node bc : root_.child("Boundary").children("bc"))
    EXPECT_EQ(sets.count(bc.attribute("node_set").value()), 1U);
  for (pugi::xml_node load : root_.child("Loads").children("nodal_load")) {
    EXPECT_EQ(sets.count(load.attribute("node_set").value()), 1U);
    EXPECT_EQ(maps.count(load.child_value("value")), 1U);
  }
  for (pugi::xml_node bc : root_.child("Rigid").children("rigid_bc"))
    EXPECT_EQ(materials.count(bc.child_value("rb")), 1U);
  for (pugi::xml_node contact : root_.child("Contact").children("contact")) {
    EXPECT_EQ(pairs.count(contact.attribute("surface_pair").value()), 1U);
  }
}

TEST_F(FebioInput, SectionsComeInTheOrderOfTheSpecification) {
  load(specimen());
  std::vector<std::string> names;
  for (pugi::xml_node section : root_.children()) {
    if (section.type() == pugi::node_element) names.emplace_back(section.name());
  }
  EXPECT_STREQ(root_.attribute("version").value(), "4.0");
  EXPECT_EQ(names, (std::vector<std::string>{"Module", "Control", "Material", "Mesh", "MeshDomains", "MeshData",
                                             "Boundary", "Rigid", "Loads", "Contact", "LoadData", "Output"}));
  EXPECT_STREQ(root_.child("Control").child_value("analysis"), "STATIC");
  EXPECT_STREQ(root_.child("Module").child_value("units"), "mm-kg-s");
  EXPECT_THAT(comments(document_), HasSubstr("mm, kg, s"));
}

TEST_F(FebioInput, HoldsEachAxisOfTheModelOnceAtItsPlace) {
  const TissueModel model = specimen();
  load(model);
  std::vector<std::array<int, 3>> count(model.mesh.vertices.size(), {0, 0, 0});
  const std::string axes = "xyz";
  for (pugi::xml_node bc : root_.child("Boundary").children("bc")) {
    const bool is_fixed = std::string(bc.attribute("type").value()) == "zero displacement";
    for (const double node : node_set(bc.attribute("node_set").value())) {
      const auto v = static_cast<std::size_t>(node) - 1;
      for (std::size_t i = 0; i < 3; ++i) {
        if (is_fixed ? bc.child((axes.substr(i, 1) + "_dof").c_str()).text().as_int() == 0
                     : bc.child_value("dof") != axes.substr(i, 1))
          continue;
        ++count[v][i];
        const double value = is_fixed ? 0.0 : bc.child("value").text().as_double();
        EXPECT_EQ(value, model.prescribed_displacement_mm[v][static_cast<int>(i)]) << "vertex " << v;
      }
    }
  }
  for (std::size_t v = 0; v < count.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_EQ(count[v][i], model.is_fixed[v][i] ? 1 : 0) << "vertex " << v << " axis " << axes[i];
  }
}

TEST_F(FebioInput, VertexForcesAddUpToTheModelsLoads) {
  const TissueModel model = specimen();
  load(model);
  Points sum(model.mesh.vertices.size(), Vec3::Zero());
  for (pugi::xml_node data : root_.child("MeshData").children("NodeData")) {
    const std::vector<double> set = node_set(data.attribute("node_set").value());
    for (pugi::xml_node item : data) {
      const std::vector<double> f = numbers(item.text().get());
      sum[static_cast<std::size_t>(set.at(item.attribute("lid").as_uint() - 1)) - 1] += Vec3(f.at(0), f.at(1), f.at(2));
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    ASSERT_LT((sum[v] - model.dead_load_mn[v]).norm(), 1e-12) << "vertex " << v;
}

TEST_F(FebioInput, APlatformIsARigidPlateFacingTheTissue) {
  const TissueModel model = specimen();
  load(model);
  const std::vector<pugi::xml_node> groups(mesh_.children("Nodes").begin(), mesh_.children("Nodes").end());
  ASSERT_EQ(groups.size(), 2U);
  Points plate;
  for (pugi::xml_node node : groups[1]) {
    const std::vector<double> p = numbers(node.text().get());
    plate.emplace_back(p.at(0), p.at(1), p.at(2));
  }
  ASSERT_EQ(plate.size(), 4U);
  for (const Vec3& p : plate) EXPECT_NEAR(p.z(), -0.7, 1e-12);
  EXPECT_GT((plate[1] - plate[0]).cross(plate[2] - plate[0]).z(), 0.0);
  EXPECT_STREQ(root_.child("Contact").child("contact").attribute("type").value(), "sliding-elastic");
}

TEST_F(FebioInput, AHolderIsARigidShellOfItsOwnTriangles) {
  const TissueModel model = specimen({}, {FixedConstraint{testing::slab_x(0.1)}, testing::holder()});
  load(model);
  const pugi::xml_node shell = mesh_.find_child_by_attribute("Elements", "name", "constraint_1_support");
  ASSERT_EQ(std::distance(shell.begin(), shell.end()), 2);
  const double first = static_cast<double>(model.mesh.vertices.size()) + 1;
  EXPECT_EQ(numbers(shell.first_child().text().get()), (std::vector<double>{first, first + 1, first + 2}));
  EXPECT_STREQ(
      root_.child("Material").find_child_by_attribute("name", "constraint_1_support").attribute("type").value(),
      "rigid body");
}

TEST_F(FebioInput, TheLawIsTheNearestAndItsDifferenceIsSaid) {
  load(specimen());
  const pugi::xml_node material = root_.child("Material").child("material");
  const pugi::xml_node law = root_.child("Material").find_child_by_attribute("name", "tissue");
  ASSERT_TRUE(material);
  EXPECT_STREQ(law.attribute("type").value(), "isotropic elastic");
  EXPECT_EQ(law.child("E").text().as_double(), 70.0);
  EXPECT_EQ(law.child("v").text().as_double(), 0.49);
  EXPECT_EQ(law.child("density").text().as_double(), 1040e-9);
  EXPECT_THAT(comments(document_), HasSubstr("no corotational law"));
  Material neo{.model = MaterialModel::StableNeoHookean};
  load(specimen(neo));
  EXPECT_STREQ(root_.child("Material").find_child_by_attribute("name", "tissue").attribute("type").value(),
               "neo-Hookean");
}

TEST_F(FebioInput, AStiffnessThatVariesIsAMapWithOneItemPerTet) {
  MaterialField field;
  field.youngs_modulus_kpa.assign(testing::odd_block().tets.size(), 70.0);
  field.youngs_modulus_kpa[5] = 700.0;
  load(specimen({}, testing::every_kind(), field));
  const pugi::xml_node law = root_.child("Material").find_child_by_attribute("name", "tissue");
  EXPECT_STREQ(law.child("E").attribute("type").value(), "map");
  const pugi::xml_node data =
      root_.child("MeshData").find_child_by_attribute("ElementData", "name", law.child_value("E"));
  std::size_t t = 0;
  for (pugi::xml_node item : data) {
    ASSERT_EQ(item.attribute("lid").as_uint(), t + 1);
    EXPECT_NEAR(item.text().as_double(), field.youngs_modulus_kpa.at(t), 1e-9);
    ++t;
  }
  EXPECT_EQ(t, field.youngs_modulus_kpa.size());
}

TEST_F(FebioInput, ATitleWithControlCharactersAndHyphensStaysXml) {
  const TissueModel model = specimen();
  const std::string text = febio_input_xml({model, Vec3::Zero(), "a\x01\x1b" "b\tc---d", ""});
  EXPECT_THAT(text, HasSubstr("ab\tc- - -d"));
  EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 && c != '\t' && c != '\n'; }));
}

TEST_F(FebioInput, StiffeningTissueIsRefused) {
  Material stiffening{.model = MaterialModel::StableNeoHookean, .stiffening = 0.469};
  const TissueModel model = specimen(stiffening);
  EXPECT_EQ(refused_field([&] {
              return febio_input_xml({model, Vec3::Zero(), "", ""});
            }),
            "specimen.material.stiffening");
}

TEST_F(FebioInput, FibresAreRefused) {
  Material fibrous{.fibre_modulus_kpa = 30.0};
  const TissueModel model = specimen(fibrous);
  EXPECT_EQ(refused_field([&] {
              return febio_input_xml({model, Vec3::Zero(), "", ""});
            }),
            "specimen.material.fibre_modulus_kpa");
}

}  // namespace
}  // namespace incise
