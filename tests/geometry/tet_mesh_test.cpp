#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Kind = MeshProblem::Kind;

VertexId vertex_id(std::size_t i) {
  return VertexId{i};
}

TetMesh one_tet() {
  TetMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
               .tets = {{vertex_id(0), vertex_id(1), vertex_id(2), vertex_id(3)}}};
  return mesh;
}

std::vector<Kind> kinds_of(const TetMesh& mesh) {
  std::vector<Kind> kinds;
  for (const MeshProblem& problem : find_problems(mesh)) kinds.push_back(problem.kind);
  return kinds;
}

TEST(SignedVolume, IsOneSixthForTheUnitTetAndNegativeWhenMirrored) {
  const TetMesh mesh = one_tet();
  EXPECT_DOUBLE_EQ(volume_mm3(mesh), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(signed_volume(mesh.vertices[0], mesh.vertices[2], mesh.vertices[1], mesh.vertices[3]), -1.0 / 6.0);
}

TEST(FaceOf, RunsCounterClockwiseSeenFromOutside) {
  const TetMesh mesh = one_tet();
  const Vec3 centre(0.25, 0.25, 0.25);
  for (int face = 0; face < 4; ++face) {
    const Triangle corners = face_of(mesh.tets[0], face);
    const Vec3& a = vertex(mesh.vertices, corners[0]);
    const Vec3 normal = (vertex(mesh.vertices, corners[1]) - a).cross(vertex(mesh.vertices, corners[2]) - a);
    EXPECT_GT(normal.dot(a - centre), 0.0) << "face " << face;
    EXPECT_EQ(std::count(corners.begin(), corners.end(), mesh.tets[0][static_cast<std::size_t>(face)]), 0);
  }
  EXPECT_THROW((void)face_of(mesh.tets[0], 4), InvalidArgument);
}

TEST(MakeBlock, FillsItsBoxWithSixValidTetsPerCell) {
  const TetMesh mesh = make_block({3, 4, 5}, {2, 3, 4});
  EXPECT_EQ(mesh.vertices.size(), 3U * 4U * 5U);
  EXPECT_EQ(mesh.tets.size(), 6U * 24U);
  EXPECT_NEAR(volume_mm3(mesh), 60.0, 1e-10);
  EXPECT_THAT(find_problems(mesh), ::testing::IsEmpty());
  EXPECT_LT((mesh.vertices[1] - Vec3(1.5, 0, 0)).norm(), 1e-12) << "x runs fastest";
}

TEST(BoundaryFaces, OfABlockCoverItsSixSides) {
  const TetMesh mesh = make_block({3, 4, 5}, {2, 3, 4});
  EXPECT_EQ(boundary_faces(mesh).size(), 2U * 2U * (2U * 3U + 3U * 4U + 4U * 2U));
  EXPECT_NEAR(enclosed_volume_mm3(boundary_surface(mesh)), 60.0, 1e-10);
}

TEST(BoundaryFaces, ComeInOrderOfTetThenFaceAndNameTheirTet) {
  const TetMesh mesh = make_block({1, 1, 1}, {1, 1, 1});
  const std::vector<BoundaryFace> faces = boundary_faces(mesh);
  EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.tet < b.tet; }));
  for (const BoundaryFace& face : faces) {
    const Tet& tet = mesh.tets[face.tet.index()];
    for (const VertexId id : face.corners) EXPECT_NE(std::find(tet.begin(), tet.end(), id), tet.end());
  }
}

TEST(BoundaryFaces, SkipDeadTetsAndShowTheWallsTheyLeave) {
  const TetMesh mesh = make_block({1, 1, 1}, {1, 1, 1});
  std::vector<std::uint8_t> is_live(6, 0);
  EXPECT_TRUE(boundary_faces(mesh, is_live).empty());
  is_live[2] = 1;
  const std::vector<BoundaryFace> faces = boundary_faces(mesh, is_live);
  ASSERT_EQ(faces.size(), 4U);
  for (int f = 0; f < 4; ++f) EXPECT_EQ(faces[static_cast<std::size_t>(f)].corners, face_of(mesh.tets[2], f));
  EXPECT_THROW((void)boundary_faces(mesh, std::vector<std::uint8_t>(5, 1)), InvalidArgument);
}

TEST(BoundaryFaces, EncloseTheLiveVolumeWhateverIsCarvedAway) {
  Random random(4);
  TetMesh mesh = make_block({4, 3, 2}, {8, 6, 4});
  for (Vec3& p : mesh.vertices) p += 0.05 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<std::uint8_t> is_live;
    TriMesh surface{.vertices = mesh.vertices, .triangles = {}, .point_data = {}};
    double expected = 0.0;
    for (const Tet& t : mesh.tets) {
      is_live.push_back(random.uniform() < 0.6 ? 1 : 0);
      if (is_live.back() != 0) {
        expected += signed_volume(vertex(mesh.vertices, t[0]), vertex(mesh.vertices, t[1]), vertex(mesh.vertices, t[2]),
                                  vertex(mesh.vertices, t[3]));
      }
    }
    for (const BoundaryFace& face : boundary_faces(mesh, is_live)) surface.triangles.push_back(face.corners);
    EXPECT_NEAR(enclosed_volume_mm3(surface), expected, 1e-9);
  }
}

TEST(BoundingBox, HoldsAllPoints) {
  const Box3 box = bounding_box(Points{{1, 5, -2}, {-1, 2, 7}});
  EXPECT_EQ(box.min(), Vec3(-1, 2, -2));
  EXPECT_EQ(box.max(), Vec3(1, 5, 7));
  EXPECT_THROW((void)bounding_box({}), InvalidArgument);
}

TEST(FindProblems, IsSilentAboutASoundMesh) {
  EXPECT_THAT(kinds_of(one_tet()), ::testing::IsEmpty());
}

TEST(FindProblems, NamesAMeshWithoutTets) {
  EXPECT_THAT(kinds_of(TetMesh{}), ::testing::ElementsAre(Kind::NoTets));
}

TEST(FindProblems, FindsANumberThatIsNotFinite) {
  TetMesh mesh = one_tet();
  mesh.vertices[2].y() = std::nan("");
  const auto problems = find_problems(mesh);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].kind, Kind::NonFiniteVertex);
  EXPECT_EQ(problems[0].first_index, 2U);
  EXPECT_EQ(problems[0].text, "1 vertices have a coordinate that is not a finite number, the first is vertex 2");
}

TEST(FindProblems, FindsIndicesOutOfRangeWithoutReadingThem) {
  TetMesh mesh = one_tet();
  mesh.tets.push_back({vertex_id(0), vertex_id(1), vertex_id(2), vertex_id(4)});
  mesh.tets.push_back({vertex_id(0), vertex_id(1), vertex_id(2), VertexId{}});
  const auto problems = find_problems(mesh);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].kind, Kind::IndexOutOfRange);
  EXPECT_EQ(problems[0].first_index, 1U);
  EXPECT_EQ(problems[0].count, 2U);
}

TEST(FindProblems, FindsInvertedAndFlatTets) {
  TetMesh mesh = one_tet();
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  EXPECT_THAT(kinds_of(mesh), ::testing::ElementsAre(Kind::InvertedTet));
  mesh = one_tet();
  mesh.vertices[3] = {0.3, 0.3, 0.0};
  EXPECT_THAT(kinds_of(mesh), ::testing::ElementsAre(Kind::FlatTet));
}

TEST(FindProblems, FindsDuplicateTetsWhateverTheOrderOfTheirCorners) {
  TetMesh mesh = one_tet();
  mesh.tets.push_back({vertex_id(1), vertex_id(2), vertex_id(0), vertex_id(3)});
  EXPECT_THAT(kinds_of(mesh), ::testing::ElementsAre(Kind::DuplicateTet));
}

TEST(FindProblems, FindsAFaceOfThreeTets) {
  TetMesh mesh = one_tet();
  mesh.vertices.push_back({0, 0, -1});
  mesh.vertices.push_back({0.1, 0.1, -1});
  mesh.tets.push_back({vertex_id(0), vertex_id(2), vertex_id(1), vertex_id(4)});
  mesh.tets.push_back({vertex_id(0), vertex_id(2), vertex_id(1), vertex_id(5)});
  EXPECT_THAT(kinds_of(mesh), ::testing::ElementsAre(Kind::NonManifoldFace));
}

TEST(FindProblems, FindsUnusedVerticesAndLooseParts) {
  TetMesh mesh = one_tet();
  for (int i = 0; i < 4; ++i) mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(i)] + Vec3(5, 0, 0));
  EXPECT_THAT(kinds_of(mesh), ::testing::ElementsAre(Kind::UnusedVertex));
  mesh.tets.push_back({vertex_id(4), vertex_id(5), vertex_id(6), vertex_id(7)});
  const auto problems = find_problems(mesh);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].kind, Kind::Disconnected);
  EXPECT_EQ(problems[0].first_index, 1U);
}

TEST(FindProblems, FindsDataOfTheWrongLength) {
  TetMesh mesh = one_tet();
  mesh.point_data["displacement_mm"] = {3, std::vector<double>(12, 0.0)};
  EXPECT_THAT(kinds_of(mesh), ::testing::IsEmpty());
  mesh.cell_data["label"] = {1, {1.0, 2.0}};
  const auto problems = find_problems(mesh);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].text, "cell data 'label' holds 2 numbers, expected 1 x 1 components");
}

TEST(FaceNeighbours, AreMutual) {
  const TetMesh bar = make_block({4, 1, 1}, {4, 1, 1});  // cells of 6 tets
  const auto neighbours = face_neighbours(bar);
  std::size_t joined = 0;
  for (std::size_t tet = 0; tet < neighbours.size(); ++tet) {
    for (const std::int32_t other : neighbours[tet]) {
      if (other < 0) continue;
      ++joined;
      const auto& back = neighbours[static_cast<std::size_t>(other)];
      EXPECT_NE(std::find(back.begin(), back.end(), static_cast<std::int32_t>(tet)), back.end());
    }
  }
  // 24 tets have 96 faces; the bar's skin has 2 triangles on each of its 18 cell sides.
  EXPECT_EQ(joined, 96U - 36U);
}

}  // namespace
}  // namespace incise
