#include "io/io_test_support.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/surface_io.hpp>

#include <cstdint>
#include <cstring>
#include <limits>

namespace incise {
namespace {

using incise::testing::data_dir;
using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using incise::testing::write_file;
using ::testing::HasSubstr;
using Kind = SurfaceProblem::Kind;

Triangle triangle_of(std::size_t a, std::size_t b, std::size_t c) {
  return {VertexId(a), VertexId(b), VertexId(c)};
}

/// The four outward faces of a tet with legs of 1 mm.
TriMesh tetrahedron() {
  TriMesh surface;
  surface.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  surface.triangles = {triangle_of(0, 2, 1), triangle_of(0, 1, 3), triangle_of(1, 2, 3), triangle_of(0, 3, 2)};
  return surface;
}

std::vector<Kind> kinds_in(const TriMesh& surface) {
  std::vector<Kind> kinds;
  for (const auto& problem : find_surface_problems(surface)) kinds.push_back(problem.kind);
  return kinds;
}

std::string binary_stl(const TriMesh& surface, std::string header) {
  header.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  header.append(reinterpret_cast<const char*>(&count), 4);
  for (const Triangle& triangle : surface.triangles) {
    float numbers[12] = {};
    for (std::size_t k = 0; k < 9; ++k)
      numbers[3 + k] = static_cast<float>(vertex(surface.vertices, triangle[k / 3])[static_cast<int>(k % 3)]);
    header.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    header.append(2, '\0');
  }
  return header;
}

class SurfaceFile : public ::testing::Test {
 protected:
  TriMesh read(const std::string& name, std::string_view text) {
    return read_surface(write_file(folder_ / name, text));
  }
  std::string message(const std::string& name, std::string_view text) {
    return refusal_of<DataError>([&] { return read(name, text); });
  }
  TemporaryFolder folder_;
};

TEST_F(SurfaceFile, PlyAndVtpReadBackExactly) {
  TriMesh surface = tetrahedron();
  surface.vertices[3] = Vec3(1e-17, 1.0 / 3.0, 0.1);
  surface.point_data["normals"] = {3, {0, 0, 1, 0, 1, 0, 1, 0, 0, 0.6, 0.8, 0}};
  surface.point_data["depth_mm"] = {1, {1, 2, 3, 0.1}};
  write_ply(folder_ / "a.ply", surface);
  write_vtp(folder_ / "a.vtp", surface);
  for (const char* name : {"a.ply", "a.vtp"}) {
    const TriMesh back = read_surface(folder_ / name);
    EXPECT_EQ(back.vertices, surface.vertices);
    EXPECT_EQ(back.triangles, surface.triangles);
    EXPECT_EQ(back.point_data.at("normals").values, surface.point_data.at("normals").values);
    EXPECT_EQ(back.point_data.at("normals").components, 3);
    EXPECT_EQ(back.point_data.at("depth_mm").values, surface.point_data.at("depth_mm").values);
  }
}

TEST(SurfaceName, IsKnownInAnyCase) {
  for (const char* name : {"a.ply", "a.STL", "b/c.Obj", "a.b.vtp"}) EXPECT_TRUE(is_surface_name(name)) << name;
  for (const char* name : {"a.nrrd", "ply", "a.ply.gz", ""}) EXPECT_FALSE(is_surface_name(name)) << name;
}

TEST_F(SurfaceFile, CloudsHaveNoTriangles) {
  TriMesh cloud{.vertices = {Vec3(1, 2, 3), Vec3(4, 5, 6)}};
  write_ply(folder_ / "a.ply", cloud);
  write_vtp(folder_ / "a.vtp", cloud);
  for (const char* name : {"a.ply", "a.vtp"}) {
    EXPECT_EQ(read_cloud(folder_ / name).vertices, cloud.vertices);
    EXPECT_THAT(refusal_of<DataError>([&] { return read_surface(folder_ / name); }), HasSubstr("found no triangles"));
  }
}

constexpr const char* kAsciiPly =
    "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 4\r\nproperty float x\r\nproperty float "
    "y\r\nproperty float z\r\n"
    "property float nx\r\nproperty float ny\r\nproperty float nz\r\nproperty uchar red\r\nelement face 1\r\nproperty "
    "list uchar int vertex_index\r\n"
    "property int flags\r\nend_header\r\n1 2 0.5 1 0 0 7\r\n1 0 0 0 1 0 8\r\n1 1 0 0 0 1 9\r\n0 1 0 0 0 1 10\r\n4 0 1 "
    "2 3 99\r\n";

TEST_F(SurfaceFile, AsciiPlyMayHoldPolygonsAndFurtherProperties) {
  const TriMesh surface = read("a.ply", kAsciiPly);
  EXPECT_EQ(surface.triangles, (std::vector<Triangle>{triangle_of(0, 1, 2), triangle_of(0, 2, 3)}));
  EXPECT_EQ(surface.point_data.at("normals").values, (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(surface.point_data.at("red").values, (std::vector<double>{7, 8, 9, 10}));
}

TEST_F(SurfaceFile, StampedRasIsTurnedToLps) {
  std::string ply = kAsciiPly;
  ply.replace(ply.find("made by hand"), 12, "SPACE=RAS");
  const TriMesh surface = read("a.ply", ply);
  EXPECT_EQ(surface.vertices[0], Vec3(-1, -2, 0.5));
  EXPECT_EQ(surface.point_data.at("normals").values[0], -1.0);
  EXPECT_EQ(surface.point_data.at("red").values[0], 7.0);
  EXPECT_EQ(read("a.stl", binary_stl(tetrahedron(), "3D Slicer output. SPACE=RAS")).vertices[2], Vec3(-1, 0, 0));
  EXPECT_EQ(read("b.stl", binary_stl(tetrahedron(), "3D Slicer output. SPACE=LPS")).vertices[2], Vec3(1, 0, 0));
  EXPECT_EQ(read("a.obj", "# 3D Slicer output. SPACE=RAS\nv 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n").vertices[0],
            Vec3(-1, -2, 3));
}

TEST_F(SurfaceFile, StlCornersBecomeSharedVertices) {
  const TriMesh binary = read("a.stl", binary_stl(tetrahedron(), "solid although binary"));
  EXPECT_EQ(binary.vertices.size(), 4u);
  EXPECT_EQ(binary.triangles.size(), 4u);
  EXPECT_TRUE(find_surface_problems(binary).empty());
  const TriMesh ascii = read("b.stl",
                             "solid x y\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n   "
                             "vertex 0 1 0\n  endloop\n endfacet\nendsolid x y\n");
  EXPECT_EQ(ascii.triangles.size(), 1u);
  EXPECT_EQ(ascii.vertices[1], Vec3(1, 0, 0));
}

TEST_F(SurfaceFile, ObjMayCountBackwardsAndCarryTexturesAndPolygons) {
  const TriMesh surface = read(
      "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl m\nf 1/1/1 2//1 3/1 -1\n");
  EXPECT_EQ(surface.triangles, (std::vector<Triangle>{triangle_of(0, 1, 2), triangle_of(0, 2, 3)}));
}

TEST_F(SurfaceFile, ThatIsDamagedIsRefusedWithThePlace) {
  EXPECT_THAT(message("a.stl", binary_stl(tetrahedron(), "x").substr(0, 200)),
              HasSubstr("found 200 bytes, expected 284 bytes for the 4 triangles"));
  EXPECT_THAT(message("a.stl", "hello"), HasSubstr("expected an STL file"));
  EXPECT_THAT(message("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0\n"),
              HasSubstr("line 4: found 'nan'"));
  EXPECT_THAT(message("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
              HasSubstr("found the end of the file, expected 'vertex'"));
  TriMesh bad = tetrahedron();
  bad.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message("a.stl", binary_stl(bad, "x")),
              HasSubstr("triangle 0, corner 0: found not-a-number coordinates"));
  EXPECT_THAT(message("a.obj", "v 0 0 0\nf 1 2 3\n"),
              HasSubstr("line 2: found '2', expected a vertex number from 1 to 1"));
  EXPECT_THAT(message("a.obj", "v 0 0 x\n"), HasSubstr("line 1: found 'x'"));
  EXPECT_THAT(message("a.obj", "hello\n"), HasSubstr("found 'hello'"));
  EXPECT_THAT(message("a.ply", "hello\n"), HasSubstr("expected 'ply'"));
  EXPECT_THAT(message("a.ply", "ply\nformat binary_big_endian 1.0\n"), HasSubstr("found 'binary_big_endian'"));
  EXPECT_THAT(message("a.ply", std::string_view(kAsciiPly).substr(0, std::string_view(kAsciiPly).size() - 20)),
              HasSubstr("found the end of the file"));
  EXPECT_THAT(message("a.off", "OFF"), HasSubstr("expected .ply, .stl, .obj or .vtp"));
}

TEST_F(SurfaceFile, PlyWithAMissingVertexNamesTheFace) {
  std::string ply = kAsciiPly;
  ply.replace(ply.find("4 0 1 2 3 99"), 12, "3 0 1 4 99  ");
  EXPECT_THAT(message("a.ply", ply), HasSubstr("face 0: found vertex 4, expected a vertex below 4"));
}

TEST(SurfaceProblems, AreNoneForAClosedOutwardSurface) {
  EXPECT_TRUE(find_surface_problems(tetrahedron()).empty());
  EXPECT_NO_THROW(require_closed_manifold(tetrahedron(), "a.stl"));
}

TEST(SurfaceProblems, NameTheOpenEdges) {
  TriMesh surface = tetrahedron();
  surface.triangles.pop_back();
  const auto problems = find_surface_problems(surface);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].kind, Kind::OpenBoundary);
  EXPECT_EQ(problems[0].count, 3u);
  EXPECT_THAT(refusal_of<DataError>([&] { require_closed_manifold(surface, "a.stl"); }),
              HasSubstr("a.stl: surface: found an open boundary (one triangle only) at 3 edges, the first from vertex "
                        "0 to 2, expected a closed"));
}

TEST(SurfaceProblems, NameAnEdgeWhereMoreThanTwoTrianglesMeet) {
  TriMesh surface = tetrahedron();
  surface.vertices.push_back(Vec3(1, 1, 1));
  surface.triangles.push_back(triangle_of(0, 1, 4));
  EXPECT_EQ(kinds_in(surface), (std::vector<Kind>{Kind::NonManifoldEdge, Kind::OpenBoundary}));
  EXPECT_THAT(refusal_of<DataError>([&] { require_closed_manifold(surface, "a.stl"); }),
              HasSubstr("more than two triangles meet (non-manifold) at 1 edge, the first from vertex 0 to 1"));
}

TEST(SurfaceProblems, FindMixedAndInwardOrientation) {
  TriMesh surface = tetrahedron();
  std::swap(surface.triangles[0][0], surface.triangles[0][1]);
  EXPECT_EQ(kinds_in(surface), (std::vector<Kind>{Kind::InconsistentOrientation}));
  surface = tetrahedron();
  for (auto& triangle : surface.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(kinds_in(surface), (std::vector<Kind>{Kind::InsideOut}));
}

TEST(SurfaceProblems, FindBadVerticesIndicesAndDegenerateTriangles) {
  TriMesh surface = tetrahedron();
  surface.vertices[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kinds_in(surface), (std::vector<Kind>{Kind::NonFiniteVertex}));
  surface = tetrahedron();
  surface.triangles[1][2] = VertexId(4);
  EXPECT_EQ(kinds_in(surface), (std::vector<Kind>{Kind::IndexOutOfRange}));
  surface = tetrahedron();
  surface.triangles.push_back(triangle_of(0, 0, 1));
  EXPECT_EQ(kinds_in(surface).front(), Kind::DegenerateTriangle);
  EXPECT_EQ(kinds_in({}), (std::vector<Kind>{Kind::NoTriangles}));
}

TEST(RealSurfaces, HaveThePublishedCounts) {
  INCISE_NEEDS_DATA_DIR();
  const auto folder = *data_dir() / "meshes/artisynth_tongue";
  const TriMesh open = read_surface(folder / "tongue.obj");
  EXPECT_EQ(open.vertices.size(), 433u);
  EXPECT_EQ(open.triangles.size(), 724u);
  const auto problems = find_surface_problems(open);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems[0].kind, Kind::OpenBoundary);
  EXPECT_EQ(problems[0].count, 8u);
  const TriMesh dense = read_surface(folder / "tongueIan.obj");
  EXPECT_EQ(dense.vertices.size(), 36647u);
  EXPECT_EQ(dense.triangles.size(), 73290u);
}

TEST(RealSurfaces, ThePrismOfTheCuttingDataIsClosedAndHasItsVolume) {
  INCISE_NEEDS_DATA_DIR();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*data_dir() / "cutting")) {
    if (entry.path().filename() != "ansys_prism_5mm.stl") continue;
    const TriMesh surface = read_surface(entry.path());
    EXPECT_NO_THROW(require_closed_manifold(surface, entry.path()));
    EXPECT_NEAR(enclosed_volume_mm3(surface) * 1e6, 500.0, 0.1) << "cm³";
    return;
  }
  GTEST_SKIP() << "no ansys_prism_5mm.stl among the shared data";
}

}  // namespace
}  // namespace incise
