#include <incise/core/ids.hpp>

#include <gtest/gtest.h>

#include <type_traits>

namespace incise {
namespace {

TEST(Ids, OfDifferentThingsAreDifferentTypes) {
  EXPECT_FALSE((std::is_convertible_v<VertexId, TetId>));
  EXPECT_FALSE((std::is_constructible_v<VertexId, TetId>));
  EXPECT_FALSE((std::is_convertible_v<TriangleId, TetId>));
  EXPECT_FALSE((std::is_convertible_v<std::size_t, VertexId>));
}

TEST(Ids, BeginAsNone) {
  EXPECT_FALSE(TetId{}.is_valid());
  EXPECT_TRUE(TetId{std::size_t{0}}.is_valid());
}

TEST(Ids, KeepTheirPositionAndOrder) {
  EXPECT_EQ(VertexId{std::size_t{17}}.index(), 17U);
  EXPECT_LT(VertexId{std::size_t{3}}, VertexId{std::size_t{4}});
  EXPECT_EQ(VertexId{std::size_t{3}}, VertexId{std::size_t{3}});
  EXPECT_EQ(sizeof(VertexId), 4U);
}

}  // namespace
}  // namespace incise
