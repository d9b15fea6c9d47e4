// Files that other programs wrote, or could have written: every format and encoding that read_tet_mesh knows.
#include "io/io_test_support.hpp"

#include <incise/io/mesh_io.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

using incise::testing::data_dir;
using incise::testing::TemporaryFolder;
using incise::testing::write_file;

Tet tet_of(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  return {VertexId(a), VertexId(b), VertexId(c), VertexId(d)};
}

class FileOfVtk : public ::testing::TestWithParam<const char*> {};

TEST_P(FileOfVtk, GivesTheMeshThatVtkWrote) {
  const TetMesh mesh = read_tet_mesh(std::filesystem::path(INCISE_VTK_FILES) / GetParam());
  const Points expected{Vec3(0.1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1.0 / 3.0)};
  ASSERT_EQ(mesh.vertices.size(), expected.size());
  const double tolerance = std::string_view(GetParam()).find("ascii") == 0 ? 1e-11 : 0.0;  // VTK prints 11 digits
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_LE((mesh.vertices[i] - expected[i]).norm(), tolerance) << "vertex " << i;
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{tet_of(0, 1, 2, 3), tet_of(1, 2, 3, 4)}));
  EXPECT_EQ(mesh.cell_data.at("region").values, (std::vector<double>{7, 9}))
      << "the triangle between the tets has no place here";
  const DataArray& displacement = mesh.point_data.at("displacement_mm");
  EXPECT_EQ(displacement.components, 3);
  EXPECT_NEAR(displacement.values.at(12), 0.1 * 4, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Encodings, FileOfVtk,
                         ::testing::Values("ascii.vtu", "binary.vtu", "binary_zlib.vtu", "appended_raw.vtu",
                                           "appended_raw_zlib.vtu", "appended_base64.vtu", "appended_base64_zlib.vtu",
                                           "big_endian.vtu", "ascii_42.vtk", "binary_42.vtk", "ascii_51.vtk",
                                           "binary_51.vtk"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

constexpr const char* kGmsh22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 5 "tongue $ 1"
$EndPhysicalNames
$Nodes
5
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
50 1 1 1
$EndNodes
$Elements
3
1 2 2 4 6 10 20 30
2 4 2 5 1 10 20 30 40
3 4 2 5 1 20 30 40 50
$EndElements
$NodeData
1
"temperature c"
1
0.0
3
0
1
5
10 1
20 2
30 3
40 4
50 5.5
$EndNodeData
$ElementData
1
"stress"
1
0.0
3
0
1
3
1 0
2 22
3 33
$EndElementData
)";

constexpr const char* kGmsh41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
1 0 0 1
1 0 0 0 0
1 0 0 0 1 1 1 1 5 0
$EndEntities
$Nodes
2 5 10 50
0 1 0 1
10
0 0 0
3 1 0 4
20
30
40
50
1 0 0
0 1 0
0 0 1
1 1 1
$EndNodes
$Elements
2 3 1 3
2 1 2 1
1 10 20 30
3 1 4 2
2 10 20 30 40
3 20 30 40 50
$EndElements
)";

constexpr const char* kGmsh1 = R"($NOD
4
1 0 0 0
2 1 0 0
3 0 1 0
7 0 0 1
$ENDNOD
$ELM
2
1 2 1 1 3 1 2 3
2 4 9 8 4 1 2 3 7
$ENDELM
)";

TEST(GmshFile, Version22KeepsTagsAndDataOfTheTets) {
  const TemporaryFolder folder;
  const TetMesh mesh = read_tet_mesh(write_file(folder / "a.msh", kGmsh22));
  EXPECT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{tet_of(0, 1, 2, 3), tet_of(1, 2, 3, 4)}));
  EXPECT_EQ(mesh.cell_data.at("physical").values, (std::vector<double>{5, 5}));
  EXPECT_EQ(mesh.cell_data.at("geometrical").values, (std::vector<double>{1, 1}));
  EXPECT_EQ(mesh.point_data.at("temperature c").values, (std::vector<double>{1, 2, 3, 4, 5.5}));
  EXPECT_EQ(mesh.cell_data.at("stress").values, (std::vector<double>{22, 33}));
}

TEST(GmshFile, Version41FindsThePhysicalTagOfTheVolume) {
  const TemporaryFolder folder;
  const TetMesh mesh = read_tet_mesh(write_file(folder / "a.msh", kGmsh41));
  EXPECT_EQ(mesh.vertices.back(), Vec3(1, 1, 1));
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{tet_of(0, 1, 2, 3), tet_of(1, 2, 3, 4)}));
  EXPECT_EQ(mesh.cell_data.at("physical").values, (std::vector<double>{5, 5}));
}

TEST(GmshFile, Version1) {
  const TemporaryFolder folder;
  const TetMesh mesh = read_tet_mesh(write_file(folder / "a.msh", kGmsh1));
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{tet_of(0, 1, 2, 3)}));
  EXPECT_EQ(mesh.cell_data.at("physical").values, (std::vector<double>{9}));
  EXPECT_EQ(mesh.cell_data.at("geometrical").values, (std::vector<double>{8}));
}

TEST(TetGenFile, MayCountFromZeroOrFromOneAndHasUnnamedColumns) {
  const TemporaryFolder folder;
  for (const int base : {0, 1}) {
    std::string nodes = "# a comment\n4 3 1 1\n", tets = fmt::format("1 4 1\n{}", base);
    const char* points[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
    for (int i = 0; i < 4; ++i) {
      nodes += fmt::format("{} {} {} -1 # end\n", base + i, points[i], i * 0.5);
      tets += fmt::format(" {}", base + i);
    }
    write_file(folder / "a.1.node", nodes);
    write_file(folder / "a.1.ele", tets + " 3\n");
    const TetMesh mesh = read_tet_mesh(folder / (base == 0 ? "a.1.node" : "a.1.ele"));
    EXPECT_EQ(mesh.tets, (std::vector<Tet>{tet_of(0, 1, 2, 3)}));
    EXPECT_EQ(mesh.point_data.at("attribute_0").values, (std::vector<double>{0, 0.5, 1, 1.5}));
    EXPECT_EQ(mesh.point_data.at("boundary_marker").values[0], -1.0);
    EXPECT_EQ(mesh.cell_data.at("attribute_0").values, (std::vector<double>{3}));
  }
}

struct RealMesh {
  const char* file;
  std::size_t vertices, tets;
};
class RealMeshFile : public ::testing::TestWithParam<RealMesh> {};

TEST_P(RealMeshFile, HasThePublishedCounts) {
  INCISE_NEEDS_DATA_DIR();
  const TetMesh mesh = read_tet_mesh(*data_dir() / GetParam().file);
  EXPECT_EQ(mesh.vertices.size(), GetParam().vertices);
  EXPECT_EQ(mesh.tets.size(), GetParam().tets);
}

INSTANTIATE_TEST_SUITE_P(Data, RealMeshFile,
                         ::testing::Values(RealMesh{"meshes/artisynth_tongue/tongue.1.node", 2228, 11098},
                                           RealMesh{"meshes/lrquad_tongue/tongue_tuned_v3.1.ele", 5452, 21051},
                                           RealMesh{"meshes/sofa/liver2.msh", 507, 1493},
                                           RealMesh{"meshes/sofa/cylinder.msh", 510, 2430},
                                           RealMesh{"fem/sofa_phantom_cylinder/truthcylinder1.msh", 642, 2524}),
                         [](const auto& parameter) {
                           return std::filesystem::path(parameter.param.file).stem().stem().string();
                         });

TEST(RealMeshes, TheTongueHasItsVolumeInMetres) {
  INCISE_NEEDS_DATA_DIR();
  const TetMesh mesh = read_tet_mesh(*data_dir() / "meshes/artisynth_tongue/tongue.1.node");
  EXPECT_NEAR(volume_mm3(mesh) * 1e6, 96.2, 0.05) << "cm³";
  EXPECT_NEAR(bounding_box(mesh.vertices).sizes().x(), 0.0747, 0.00005);
}

TEST(RealMeshes, SofasBlockIsReadFromItsLegacyFile) {
  INCISE_NEEDS_DATA_DIR();
  const TetMesh mesh = read_tet_mesh(*data_dir() / "fem/sofa_block/block_3k.vtk");
  EXPECT_EQ(mesh.tets.size(), 2880u);
  EXPECT_NEAR(volume_mm3(mesh), 100.0 * 60.0 * 25.0, 1e-6);
}

TEST(RealMeshes, HexahedraAreRefused) {
  INCISE_NEEDS_DATA_DIR();
  EXPECT_THAT(incise::testing::refusal_of<DataError>([] {
                static_cast<void>(read_tet_mesh(*data_dir() / "fem/sofa_phantom_cylinder/cylinder_Hexa.msh"));
              }),
              ::testing::HasSubstr("found element type 5, expected linear tetrahedra"));
}

}  // namespace
}  // namespace incise
