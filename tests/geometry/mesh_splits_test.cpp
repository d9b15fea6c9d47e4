#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/mesh_splits.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::HasSubstr;

constexpr VertexId v(std::size_t i) {
  return VertexId(i);
}

/// Two tets with a common face, 1 2 3.
TetMesh pair() {
  TetMesh mesh;
  mesh.vertices = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  mesh.tets = {{v(0), v(2), v(1), v(3)}, {v(4), v(1), v(2), v(3)}};
  mesh.point_data["number"] = {1, {0, 1, 2, 3, 4}};
  mesh.cell_data["pair"] = {2, {10, 11, 20, 21}};
  return mesh;
}

/// The second tet in two parts, the first of which leaves vertex 1; then the other part leaves it, too.
MeshSplits splits() {
  MeshSplits splits;
  splits.vertices = {v(1), v(5)};
  splits.copies = {{TetId(1), {v(4), v(6), v(2), v(3)}, 0.25}};
  splits.changed = {{TetId(1), {v(4), v(5), v(2), v(3)}, 0.75}};
  return splits;
}

TEST(MeshSplits, CopiesFollowAndHaveTheirOriginalsData) {
  const TetMesh mesh = split_mesh(pair(), splits());
  ASSERT_EQ(mesh.vertices.size(), 7U);
  EXPECT_EQ(mesh.vertices[5], pair().vertices[1]);
  EXPECT_EQ(mesh.vertices[6], pair().vertices[1]) << "a copy of a copy";
  ASSERT_EQ(mesh.tets.size(), 3U);
  EXPECT_EQ(mesh.tets[0], pair().tets[0]);
  EXPECT_EQ(mesh.tets[1], splits().changed[0].corners);
  EXPECT_EQ(mesh.tets[2], splits().copies[0].corners);
  EXPECT_THAT(mesh.point_data.at("number").values, ::testing::ElementsAre(0, 1, 2, 3, 4, 1, 1));
  EXPECT_THAT(mesh.cell_data.at("pair").values, ::testing::ElementsAre(10, 11, 20, 21, 20, 21));
  EXPECT_EQ(whole_vertices(5, splits())[6], v(1));
}

TEST(MeshSplits, TheSharesOfATetAddUpToOne) {
  EXPECT_EQ(share_of(splits(), 2, TetId(0)), 1.0);
  EXPECT_EQ(share_of(splits(), 2, TetId(1)) + share_of(splits(), 2, TetId(2)), 1.0);
}

TEST(MeshSplits, OfAnotherMeshAreRefused) {
  const auto refusal = [](const MeshSplits& bad) {
    return testing::refusal_of<InvalidArgument>([&] { return split_mesh(pair(), bad); });
  };
  MeshSplits bad = splits();
  bad.vertices[0] = v(5);
  EXPECT_THAT(refusal(bad), HasSubstr("expected one of 5 vertices, found 5")) << "itself";
  bad = splits();
  bad.copies[0].whole = TetId(2);
  EXPECT_THAT(refusal(bad), HasSubstr("expected one of 2 tets, found 2"));
  bad = splits();
  bad.copies[0].corners[0] = v(6);
  EXPECT_THAT(refusal(bad), HasSubstr("a copy of the tet's own, found 6"));
  bad.copies[0].corners[0] = v(7);
  EXPECT_THAT(refusal(bad), HasSubstr("found 7"));
  bad = splits();
  bad.copies[0].share = 0.5;
  EXPECT_THAT(refusal(bad), HasSubstr("shares of tet 1 that add up to 1, found 1.25"));
  bad.copies[0].share = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(bad), HasSubstr("a share of tet 1 in [0, 1]"));
  bad = splits();
  bad.changed.push_back(bad.changed.front());
  EXPECT_THAT(refusal(bad), HasSubstr("in ascending order, each once"));
  bad = splits();
  bad.copies[0].share = 1.0;
  bad.changed.clear();  // the whole tet would keep its share of 1, too
  EXPECT_THAT(refusal(bad), HasSubstr("expected tet 1 among the changed ones"));
}

}  // namespace
}  // namespace incise
