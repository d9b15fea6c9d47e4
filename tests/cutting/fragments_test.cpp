#include "fragments.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace incise {
namespace {

/// 4 x 1 x 1 cells of 6 tets each: tets 6 c … 6 c + 5 fill cell c.
const TetMesh kBar = make_block({4, 1, 1}, {4, 1, 1});

/// The bar without some of its tets.
struct CutBar {
  std::vector<double> volumes = std::vector<double>(kBar.tets.size(), 1.0 / 6.0);
  std::vector<std::uint8_t> is_live = std::vector<std::uint8_t>(kBar.tets.size(), 1);
  std::vector<std::uint8_t> is_anchored = std::vector<std::uint8_t>(kBar.vertices.size(), 0);
  std::vector<TetId> removed;

  void remove_cell(std::size_t cell) {
    for (std::size_t tet = 6 * cell; tet < 6 * cell + 6; ++tet) {
      is_live[tet] = 0;
      removed.emplace_back(tet);
    }
  }
  [[nodiscard]] std::vector<TetId> loose(double least_mm3) const {
    return loose_fragments(kBar, volumes, face_adjacency(kBar), is_live, is_anchored, removed, least_mm3);
  }
};

TEST(LooseFragments, APartCutOffFromTheBodyIsFound) {
  CutBar bar;
  bar.remove_cell(2);  // the fourth hangs by nothing; the first two together are large enough to stay
  const std::vector<TetId> loose = bar.loose(1.5);
  ASSERT_EQ(loose.size(), 6U);
  EXPECT_EQ(loose.front().index(), 18U);
  EXPECT_EQ(loose.back().index(), 23U);
}

TEST(LooseFragments, VolumeCountsNotTheNumberOfTets) {
  CutBar bar;
  bar.remove_cell(2);
  for (std::size_t tet = 18; tet < 24; ++tet) bar.volumes[tet] = 1.0;  // as many tets, six times the tissue
  EXPECT_TRUE(bar.loose(1.5).empty());
}

TEST(LooseFragments, EveryPartBesideTheCutIsLookedAt) {
  CutBar bar;
  bar.remove_cell(1);
  bar.remove_cell(2);
  EXPECT_EQ(bar.loose(1.5).size(), 12U) << "the first cell and the last, each loose";
}

TEST(LooseFragments, APartThatHasChangedIsLookedAtItself) {
  CutBar bar;
  bar.remove_cell(2);
  bar.removed = {TetId(20)};  // of the fourth cell, live
  EXPECT_EQ(bar.loose(1.5).size(), 6U);
}

TEST(FaceAdjacency, PartsOfOneTetAreNeighboursOfTheTetAcrossTheFaceNotOfEachOther) {
  TetMesh mesh;
  const auto tet = [](std::size_t a) { return Tet{VertexId(a), VertexId(0), VertexId(1), VertexId(2)}; };
  mesh.vertices.resize(6, Vec3::Zero());
  mesh.tets = {tet(3), tet(4), tet(5)};  // the last is a copy of the first with a corner of its own
  TetMesh whole = mesh;
  whole.tets.pop_back();
  MeshSplits splits{.copies = {{TetId(0), mesh.tets[2], 0.5}}, .changed = {{TetId(0), mesh.tets[0], 0.5}}};
  const FaceAdjacency adjacency = split_adjacency(mesh, splits, face_adjacency(whole));
  const auto list = [&](std::size_t t) { return std::vector(adjacency.of(t).begin(), adjacency.of(t).end()); };
  EXPECT_EQ(list(0), std::vector{1});
  EXPECT_EQ(list(1), (std::vector{0, 2}));
  EXPECT_EQ(list(2), std::vector{1});
}

TEST(LooseFragments, AnAnchoredPartStays) {
  CutBar bar;
  bar.remove_cell(2);
  for (std::size_t v = 0; v < kBar.vertices.size(); ++v) bar.is_anchored[v] = kBar.vertices[v].x() > 3.5 ? 1 : 0;
  EXPECT_TRUE(bar.loose(1.5).empty());
}

TEST(LooseFragments, AnUncutBodyHasNone) { EXPECT_TRUE(CutBar().loose(1.5).empty()); }

}  // namespace
}  // namespace incise
