#include <incise/core/error.hpp>
#include <incise/meshing/quality.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace incise {
namespace {

constexpr double kExact = 1e-9;

Tet tet_of(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  return {VertexId(a), VertexId(b), VertexId(c), VertexId(d)};
}

/// Four alternate corners of a cube of edge 2: a regular tet of edge 2 √2 and volume 8/3.
TetMesh regular_tet() {
  return {.vertices = {{0, 0, 0}, {2, 2, 0}, {0, 2, 2}, {2, 0, 2}},
          .tets = {tet_of(0, 1, 2, 3)},
          .point_data = {},
          .cell_data = {}};
}

TetMesh corner_tet() {
  return {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .tets = {tet_of(0, 1, 2, 3)},
          .point_data = {},
          .cell_data = {}};
}

TEST(MeshQuality, OfARegularTetIsPerfect) {
  const MeshQuality quality = quality_of(regular_tet());
  EXPECT_NEAR(quality.min_dihedral_deg, 70.528779365509, kExact);
  EXPECT_NEAR(quality.max_dihedral_deg, 70.528779365509, kExact);
  EXPECT_NEAR(quality.min_radius_ratio, 1.0, kExact);
  EXPECT_NEAR(quality.volume_mm3, 8.0 / 3.0, kExact);
  EXPECT_EQ(quality.edges.count, 6U);
  EXPECT_NEAR(quality.edges.mean_mm, 2.0 * std::sqrt(2.0), kExact);
  EXPECT_EQ(quality.dihedral_histogram[14], 6U);  // 70 to 75 degrees
}

TEST(MeshQuality, OfACubesCornerHasItsKnownAnglesAndRadii) {
  const MeshQuality quality = quality_of(corner_tet());
  EXPECT_NEAR(quality.max_dihedral_deg, 90.0, kExact);
  EXPECT_NEAR(quality.min_dihedral_deg, 54.735610317245, kExact);
  // r = 1 / (3 + √3), R = √3 / 2
  EXPECT_NEAR(quality.min_radius_ratio, 3.0 / (3.0 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2.0), kExact);
  EXPECT_NEAR(quality.edges.min_mm, 1.0, kExact);
  EXPECT_NEAR(quality.edges.max_mm, std::sqrt(2.0), kExact);
}

TEST(MeshQuality, CountsSharedEdgesOnce) {
  const TetMesh block = make_block(Vec3(2, 2, 2), {2, 2, 2});
  const MeshQuality quality = quality_of(block);
  EXPECT_EQ(quality.tets, 48U);
  EXPECT_EQ(quality.vertices, 27U);
  EXPECT_NEAR(quality.volume_mm3, 8.0, kExact);
  // 54 along the axes, 36 across cell faces, 8 through cells.
  EXPECT_EQ(quality.edges.count, 98U);
  EXPECT_NEAR(quality.min_dihedral_deg, 45.0, kExact);
  EXPECT_EQ(std::accumulate(quality.dihedral_histogram.begin(), quality.dihedral_histogram.end(), std::size_t{0}),
            288U);
}

TEST(MeshQuality, ShowsSlivers) {
  TetMesh sliver = regular_tet();
  sliver.vertices = {{0, 0, 0.01}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}};
  if (volume_mm3(sliver) < 0.0) std::swap(sliver.tets[0][2], sliver.tets[0][3]);
  const MeshQuality quality = quality_of(sliver);
  EXPECT_LT(quality.min_dihedral_deg, 2.0);
  EXPECT_GT(quality.max_dihedral_deg, 177.0);
  EXPECT_LT(quality.min_radius_ratio, 0.03);
}

TEST(MeshQuality, ShowsInvertedTetsAsNegativeVolume) {
  TetMesh inverted = corner_tet();
  std::swap(inverted.tets[0][0], inverted.tets[0][1]);
  const MeshQuality quality = quality_of(inverted);
  EXPECT_NEAR(quality.smallest_tet_mm3, -1.0 / 6.0, kExact);
  EXPECT_DOUBLE_EQ(quality.min_radius_ratio, 0.0);
}

TEST(MeshQuality, OfAnEmptyMeshIsZero) {
  const MeshQuality quality = quality_of({});
  EXPECT_EQ(quality.tets, 0U);
  EXPECT_DOUBLE_EQ(quality.min_dihedral_deg, 0.0);
  EXPECT_DOUBLE_EQ(quality.edges.mean_mm, 0.0);
}

TEST(MeshQuality, RefusesBrokenMeshes) {
  TetMesh mesh = corner_tet();
  mesh.tets[0][2] = VertexId(std::size_t{7});
  EXPECT_THROW(static_cast<void>(quality_of(mesh)), InvalidArgument);
  mesh = corner_tet();
  mesh.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(quality_of(mesh)), InvalidArgument);
}

TEST(EdgesWhere, MeasuresOnlyTheEdgesWhoseMiddleIsAccepted) {
  const EdgeStatistics bottom = edges_where(corner_tet(), [](const Vec3& p) { return p.z() < 0.1; });
  EXPECT_EQ(bottom.count, 3U);
  EXPECT_NEAR(bottom.mean_mm, (2.0 + std::sqrt(2.0)) / 3.0, kExact);
  EXPECT_EQ(edges_where(corner_tet(), [](const Vec3&) { return false; }).count, 0U);
}

TEST(MeshQualityText, HoldsTheNumbersAndTheHistogram) {
  const std::string text = to_text(quality_of(regular_tet()));
  EXPECT_THAT(text, ::testing::HasSubstr("tetrahedra                    1\n"));
  EXPECT_THAT(text, ::testing::HasSubstr("  70 -  75 deg          6 ####"));
}

}  // namespace
}  // namespace incise
