#include <incise/geometry/manifoldness.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

/// The skin of those tets of a 2 x 2 x 1 block whose cell is chosen by its column and row.
std::vector<Triangle> skin_of_cells(const std::vector<std::array<int, 2>>& cells) {
  const TetMesh mesh = make_block({2, 2, 1}, {2, 2, 1});
  std::vector<std::uint8_t> is_live(mesh.tets.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const VertexId v : mesh.tets[t]) middle += 0.25 * vertex(mesh.vertices, v);
    for (const auto& [i, j] : cells)
      is_live[t] |= static_cast<int>(middle.x()) == i && static_cast<int>(middle.y()) == j ? 1 : 0;
  }
  std::vector<Triangle> triangles;
  for (const BoundaryFace& face : boundary_faces(mesh, is_live)) triangles.push_back(face.corners);
  return triangles;
}

Triangle triangle(std::size_t a, std::size_t b, std::size_t c) {
  return {VertexId(a), VertexId(b), VertexId(c)};
}

/// The four faces of a tet with these corners.
void add_tet(std::vector<Triangle>& triangles, std::array<std::size_t, 4> c) {
  triangles.insert(triangles.end(), {triangle(c[1], c[2], c[3]), triangle(c[0], c[3], c[2]), triangle(c[0], c[1], c[3]),
                                     triangle(c[0], c[2], c[1])});
}

TEST(Manifoldness, TheSkinOfABlockIsAClosedManifold) {
  const std::vector<Triangle> skin = skin_of_cells({{0, 0}, {0, 1}, {1, 0}, {1, 1}});
  EXPECT_EQ(manifoldness_of(skin), (Manifoldness{skin.size(), 0, 0, 0}));
}

TEST(Manifoldness, AMissingTriangleLeavesThreeOpenEdges) {
  std::vector<Triangle> skin = skin_of_cells({{0, 0}});
  skin.pop_back();
  EXPECT_EQ(manifoldness_of(skin), (Manifoldness{skin.size(), 3, 0, 0}));
}

TEST(Manifoldness, CellsThatTouchAlongAnEdgeShareANonManifoldEdge) {
  const std::vector<Triangle> skin = skin_of_cells({{0, 0}, {1, 1}});
  EXPECT_EQ(manifoldness_of(skin), (Manifoldness{skin.size(), 0, 1, 0})) << "the edge's ends are not counted again";
}

TEST(Manifoldness, TetsThatTouchInAVertexPinchIt) {
  std::vector<Triangle> triangles;
  add_tet(triangles, {0, 1, 2, 3});
  add_tet(triangles, {0, 4, 5, 6});
  EXPECT_EQ(manifoldness_of(triangles), (Manifoldness{8, 0, 0, 1}));
}

TEST(Manifoldness, NothingHasNoFlaw) {
  EXPECT_EQ(manifoldness_of({}), Manifoldness{});
}

}  // namespace
}  // namespace incise
