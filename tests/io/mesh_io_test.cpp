#include "io/io_test_support.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/mesh_io.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using incise::testing::write_file;
using ::testing::HasSubstr;

class MeshFile : public ::testing::Test {
 protected:
  std::string message(const std::string& name, std::string_view text) {
    return refusal_of<DataError>([&] { return read_tet_mesh(write_file(folder_ / name, text)); });
  }
  TemporaryFolder folder_;
};

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("no '" + what + "' to replace");
  return text.replace(at, what.size(), with);
}

std::string ascii_vtu() {
  return read_text(std::filesystem::path(INCISE_VTK_FILES) / "ascii.vtu");
}

constexpr const char* kLegacy = R"(# vtk DataFile Version 3.0
two tets
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0  1 0 0  0 1 0  0 0 1  1 1 1
CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10 10
)";

TEST_F(MeshFile, WrittenAsVtuReadsBackExactly) {
  TetMesh mesh = make_block(Vec3(10, 7, 3), {40, 30, 5});  // 36000 tets: several compressed blocks
  for (Vec3& p : mesh.vertices) p += Vec3(std::sin(p.x()), 1e-13 * p.y(), 1.0 / 3.0) * 1e-3;
  mesh.point_data["displacement_mm"] = {3, std::vector<double>(3 * mesh.vertices.size(), -0.1)};
  mesh.cell_data["von_mises_kpa & <x>"] = {1, std::vector<double>(mesh.tets.size(), 5e-324)};
  write_vtu(folder_ / "a.vtu", mesh);
  const TetMesh back = read_tet_mesh(folder_ / "a.vtu");
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.tets, mesh.tets);
  ASSERT_EQ(back.point_data.size(), 1u);
  ASSERT_EQ(back.cell_data.size(), 1u);
  EXPECT_EQ(back.point_data.at("displacement_mm").values, mesh.point_data.at("displacement_mm").values);
  EXPECT_EQ(back.cell_data.at("von_mises_kpa & <x>").values, mesh.cell_data.at("von_mises_kpa & <x>").values);
}

TEST_F(MeshFile, SaysItsSpaceAndUnit) {
  write_vtu(folder_ / "a.vtu", make_block(Vec3(1, 1, 1), {1, 1, 1}));
  const std::string text = read_text(folder_ / "a.vtu");
  EXPECT_THAT(text, HasSubstr("<!-- SPACE=LPS, lengths in mm -->"));
}

TEST_F(MeshFile, IsNotWrittenWithNumbersThatAreNotFinite) {
  TetMesh mesh = make_block(Vec3(1, 1, 1), {1, 1, 1});
  mesh.cell_data["a"] = {1, std::vector<double>(6, std::numeric_limits<double>::infinity())};
  EXPECT_THROW(write_vtu(folder_ / "a.vtu", mesh), InvalidArgument);
  mesh.cell_data["a"] = {1, {1.0}};
  EXPECT_THROW(write_vtu(folder_ / "a.vtu", mesh), InvalidArgument);
  mesh.cell_data.clear();
  mesh.vertices[3].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_vtu(folder_ / "a.vtu", mesh), InvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(MeshFile, StampedRasIsTurnedToLps) {
  const TetMesh mesh = read_tet_mesh(
      write_file(folder_ / "a.vtu", replaced(ascii_vtu(), "<Piece",
                                             "<FieldData><Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" "
                                             "format=\"ascii\">82 65 83 0</Array></FieldData><Piece")));
  EXPECT_EQ(mesh.vertices[4], Vec3(-1, -1, 1.0 / 3.0));
  EXPECT_EQ(mesh.point_data.at("displacement_mm").values[1], 1.0);
  EXPECT_GT(volume_mm3(mesh), 0.0);
  const TetMesh legacy =
      read_tet_mesh(write_file(folder_ / "a.vtk", replaced(kLegacy, "two tets", "3D Slicer output. SPACE=RAS")));
  EXPECT_EQ(legacy.vertices[4], Vec3(-1, -1, 1));
}

TEST_F(MeshFile, WithAllTetsTheOtherWayRoundIsTurnedOver) {
  const std::string all = replaced(replaced(kLegacy, "4 0 1 2 3", "4 1 0 2 3"), "4 1 2 3 4", "4 2 1 3 4");
  const TetMesh mesh = read_tet_mesh(write_file(folder_ / "a.vtk", all));
  EXPECT_NEAR(volume_mm3(mesh), 1.0 / 6.0 + 1.0 / 3.0, 1e-15);
}

TEST_F(MeshFile, WithTetsOfBothOrientationsIsRefused) {
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "4 1 2 3 4", "4 2 1 3 4")),
              HasSubstr("a.vtk: tetrahedron 1: found a negative volume (1 of 2 tetrahedra)"));
}

TEST_F(MeshFile, WithAFlatTetIsRefused) {
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "4 1 2 3 4", "4 1 2 3 3")),
              HasSubstr("tetrahedron 1: found no volume"));
}

TEST_F(MeshFile, WithNotANumberCoordinatesNamesLineOrVertex) {
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "0 0 1  1 1 1", "0 0 1  1 nan 1")),
              HasSubstr("a.vtk: line 6: found 'nan', expected value: a finite number"));
  EXPECT_THAT(message("a.vtu", replaced(ascii_vtu(), "0.3333333333333333", "nan")),
              HasSubstr("vertex 4: found (1, 1, nan)"));
  EXPECT_THAT(message("a.msh", "$NOD\n1\n1 0 inf 0\n$ENDNOD\n"), HasSubstr("line 3: found 'inf'"));
}

TEST_F(MeshFile, WithAnIndexOutOfRangeNamesTheCell) {
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "4 1 2 3 4", "4 1 2 3 5")),
              HasSubstr("cell 1: found point index 5, expected 0 to 4"));
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "4 1 2 3 4", "4 1 2 3 -1")), HasSubstr("point index -1"));
}

TEST_F(MeshFile, WithOtherVolumeElementsIsRefused) {
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "10 10", "10 24")),
              HasSubstr("cell 1: found VTK cell type 24, expected linear tetrahedra"));
}

TEST_F(MeshFile, WithoutTetsIsRefused) {
  EXPECT_THAT(message("a.vtk", replaced(kLegacy, "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\n", "")),
              HasSubstr("found no tetrahedra"));
  EXPECT_THAT(message("a.msh", ""), HasSubstr("found no tetrahedra"));
}

TEST_F(MeshFile, ThatIsMissingOrOfAnotherKindIsNamed) {
  EXPECT_THAT(refusal_of<DataError>([&] { return read_tet_mesh(folder_ / "none.vtu"); }),
              HasSubstr("none.vtu: found no such file"));
  EXPECT_THAT(message("a.stl", ""), HasSubstr("found the ending '.stl', expected .vtu, .vtk, .msh, .node or .ele"));
  EXPECT_THAT(message("a.vtu", "solid x"), HasSubstr("expected a VTK XML file"));
  EXPECT_THAT(message("a.vtu", "<VTKFile type=\"PolyData\"/>"),
              HasSubstr("found type 'PolyData', expected type 'UnstructuredGrid'"));
  EXPECT_THAT(message("a.vtk", "hello"), HasSubstr("expected '# vtk DataFile Version"));
  write_file(folder_ / "b.node", "4 3 0 0\n");
  EXPECT_THAT(refusal_of<DataError>([&] { return read_tet_mesh(folder_ / "b.node"); }),
              HasSubstr("b.ele: found no such file"));
}

TEST_F(MeshFile, OfABinaryOrUnknownGmshVersionSaysHowToSaveIt) {
  EXPECT_THAT(message("a.msh", "$MeshFormat\n4.1 1 8\n"),
              HasSubstr("line 2: found a binary file, expected an ascii file. Save it with Mesh.Binary = 0."));
  EXPECT_THAT(message("a.msh", "$MeshFormat\n4 0 8\n"), HasSubstr("found version 4, expected Gmsh format"));
}

TEST_F(MeshFile, CompressedByAnotherMethodIsRefused) {
  EXPECT_THAT(message("a.vtu", replaced(ascii_vtu(), "<VTKFile", "<VTKFile compressor=\"vtkLZ4DataCompressor\"")),
              HasSubstr("found vtkLZ4DataCompressor"));
}

/// Cutting a file anywhere must end in a message, never in a mesh or a crash.
TEST_F(MeshFile, CutShortAnywhereIsRefused) {
  for (const char* name : {"ascii.vtu", "binary.vtu", "binary_zlib.vtu", "appended_raw.vtu", "appended_raw_zlib.vtu",
                           "appended_base64_zlib.vtu", "ascii_42.vtk", "binary_42.vtk", "binary_51.vtk"}) {
    const std::string text = read_text(std::filesystem::path(INCISE_VTK_FILES) / name);
    const bool is_xml = std::string(name).ends_with(".vtu");
    // A legacy file that ends between two sections of data is complete as far as anyone can tell.
    const std::size_t end =
        is_xml ? std::min(text.find("</AppendedData"), text.find("</VTKFile")) : text.find("CELL_TYPES");
    for (std::size_t size = 0; size < end; size += 17) {
      EXPECT_NE(message(is_xml ? "cut.vtu" : "cut.vtk", std::string_view(text).substr(0, size)), "accepted")
          << name << " cut to " << size;
    }
  }
}

/// Flipping bits must end in a mesh or in a message.
TEST_F(MeshFile, DamagedAnywhereDoesNotCrash) {
  for (const char* name : {"binary.vtu", "binary_zlib.vtu", "appended_raw.vtu", "appended_raw_zlib.vtu",
                           "binary_42.vtk", "binary_51.vtk", "ascii_51.vtk"}) {
    const std::string text = read_text(std::filesystem::path(INCISE_VTK_FILES) / name);
    for (std::size_t i = 0; i < text.size(); i += 11) {
      std::string damaged = text;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
      EXPECT_NO_FATAL_FAILURE(
          static_cast<void>(message(std::string(name).ends_with(".vtu") ? "bad.vtu" : "bad.vtk", damaged)))
          << name << " byte " << i;
    }
  }
}

}  // namespace
}  // namespace incise
