#include "fragments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace incise {
namespace {

/// 4 x 1 x 1 cells of 6 tets each: tets 6 c … 6 c + 5 fill cell c.
const TetMesh kBar = make_block({4, 1, 1}, {4, 1, 1});

TEST(FaceNeighbours, AreMutualAndShareThreeVertices) {
  const auto neighbours = face_neighbours(kBar);
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

TEST(LooseFragments, APartCutOffFromTheBodyIsFound) {
  const auto neighbours = face_neighbours(kBar);
  std::vector<std::uint8_t> is_live(kBar.tets.size(), 1);
  for (std::size_t tet = 12; tet < 18; ++tet) is_live[tet] = 0;  // the third cell goes, the fourth hangs by nothing
  const std::vector<std::uint8_t> is_anchored(kBar.vertices.size(), 0);
  const std::vector<TetId> loose = loose_fragments(kBar, neighbours, is_live, is_anchored, 0.4);
  ASSERT_EQ(loose.size(), 6U);
  EXPECT_EQ(loose.front().index(), 18U);
  EXPECT_EQ(loose.back().index(), 23U);
}

TEST(LooseFragments, AnAnchoredPartStays) {
  const auto neighbours = face_neighbours(kBar);
  std::vector<std::uint8_t> is_live(kBar.tets.size(), 1);
  for (std::size_t tet = 12; tet < 18; ++tet) is_live[tet] = 0;
  std::vector<std::uint8_t> is_anchored(kBar.vertices.size(), 0);
  for (std::size_t v = 0; v < kBar.vertices.size(); ++v) is_anchored[v] = kBar.vertices[v].x() > 3.5 ? 1 : 0;
  EXPECT_TRUE(loose_fragments(kBar, neighbours, is_live, is_anchored, 0.4).empty());
}

TEST(LooseFragments, AnUncutBodyHasNone) {
  const std::vector<std::uint8_t> is_live(kBar.tets.size(), 1);
  const std::vector<std::uint8_t> is_anchored(kBar.vertices.size(), 0);
  EXPECT_TRUE(loose_fragments(kBar, face_neighbours(kBar), is_live, is_anchored, 0.4).empty());
}

}  // namespace
}  // namespace incise
