#include "meshing/shapes.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/meshing/occupancy.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace incise {
namespace {

using ::testing::HasSubstr;

constexpr double kFloatSum = 1e-4;  // relative: thousands of floats added up

double total_mm3(const GrayVolume& volume) {
  return std::accumulate(volume.voxels.begin(), volume.voxels.end(), 0.0) * volume.grid.voxel_volume_mm3();
}

std::string message_of(const TriMesh& surface) {
  return testing::refusal_of<InvalidArgument>([&] { return occupancy_of(surface, 1.0); });
}

LabelVolume full_block() {
  LabelVolume labels;
  labels.grid.size = {4, 5, 6};
  labels.grid.spacing_mm = Vec3(1.0, 0.5, 2.0);
  labels.voxels.assign(labels.grid.voxel_count(), 2);
  return labels;
}

TEST(OccupancyOfLabels, NeitherAddsNorRemovesTissueEvenAtTheBorderOfTheVolume) {
  const LabelVolume labels = full_block();
  EXPECT_NEAR(total_mm3(occupancy_of(labels, 1.2)), 120.0, 120.0 * kFloatSum);
}

TEST(OccupancyOfLabels, WithoutBlurIsTheLabelAtTheSamePlace) {
  LabelVolume labels = full_block();
  std::fill(labels.voxels.begin(), labels.voxels.end(), std::uint8_t{0});
  labels.at(2, 3, 4) = 1;
  const GrayVolume occupancy = occupancy_of(labels, 0.0);
  const Vec3 index = occupancy.grid.index_from_world(labels.grid.world_from_index(Vec3(2, 3, 4)));
  EXPECT_FLOAT_EQ(occupancy.at(static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y())),
                               static_cast<int>(std::lround(index.z()))),
                  1.0F);
  EXPECT_NEAR(total_mm3(occupancy), 1.0, kFloatSum);
}

TEST(OccupancyOfLabels, BlursAFlatFaceToOneHalf) {
  LabelVolume labels;
  labels.grid.size = {20, 20, 20};
  labels.voxels.assign(labels.grid.voxel_count(), 1);
  const GrayVolume occupancy = occupancy_of(labels, 1.2);
  const int middle = occupancy.grid.size[1] / 2;
  const int first = static_cast<int>(std::lround(occupancy.grid.index_from_world(Vec3::Zero()).x()));
  // The face lies between voxels first - 1 and first; they are equally far from it.
  EXPECT_NEAR(occupancy.at(first, middle, middle) + occupancy.at(first - 1, middle, middle), 1.0, 1e-5);
}

TEST(OccupancyOfLabels, RefusesVolumesWithoutTissueAndBrokenGrids) {
  LabelVolume labels = full_block();
  std::fill(labels.voxels.begin(), labels.voxels.end(), std::uint8_t{0});
  EXPECT_THROW(static_cast<void>(occupancy_of(labels)), InvalidArgument);
  labels = full_block();
  labels.voxels.pop_back();
  EXPECT_THROW(static_cast<void>(occupancy_of(labels)), InvalidArgument);
  labels = full_block();
  labels.grid.spacing_mm.y() = 0.0;
  EXPECT_THROW(static_cast<void>(occupancy_of(labels)), InvalidArgument);
  labels = full_block();
  labels.grid.direction(0, 1) = 0.3;
  EXPECT_THROW(static_cast<void>(occupancy_of(labels)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(occupancy_of(full_block(), -1.0)), InvalidArgument);
}

TEST(OccupancyOfSurface, HoldsTheEnclosedVolumeOfABlockThatCutsThroughVoxels) {
  const Vec3 size(10.3, 7.7, 5.1);
  const GrayVolume occupancy = occupancy_of(testing::block_surface(size), 0.9, 0.0);
  EXPECT_NEAR(total_mm3(occupancy), size.prod(), 0.01 * size.prod());
  EXPECT_FLOAT_EQ(*std::max_element(occupancy.voxels.begin(), occupancy.voxels.end()), 1.0F);
}

TEST(OccupancyOfSurface, IsTheSameForASurfaceTurnedInsideOut) {
  TriMesh surface = testing::block_surface(Vec3(4, 5, 6));
  const GrayVolume outward = occupancy_of(surface, 0.5);
  for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_EQ(outward.voxels, occupancy_of(surface, 0.5).voxels);
}

TEST(OccupancyOfSurface, CountsWhatIsEnclosedTwiceOnce) {
  TriMesh surface = testing::block_surface(Vec3(4, 4, 4));
  const TriMesh other = testing::block_surface(Vec3(4, 4, 4));
  const std::size_t shift = surface.vertices.size();
  for (const Vec3& p : other.vertices) surface.vertices.push_back(p + Vec3(2, 0, 0));
  for (const Triangle& t : other.triangles) {
    surface.triangles.push_back(
        {VertexId(t[0].index() + shift), VertexId(t[1].index() + shift), VertexId(t[2].index() + shift)});
  }
  EXPECT_NEAR(total_mm3(occupancy_of(surface, 0.5)), 6.0 * 4.0 * 4.0, 0.01 * 96.0);
}

TEST(OccupancyOfSurface, RefusesAHoleAndSaysWhere) {
  TriMesh surface = testing::block_surface(Vec3(4, 4, 4));
  surface.triangles.pop_back();
  const std::string message = message_of(surface);
  EXPECT_THAT(message, HasSubstr("not closed and manifold"));
  EXPECT_THAT(message, HasSubstr("joins 1 triangle, expected 2"));
}

TEST(OccupancyOfSurface, RefusesAnEdgeThatJoinsThreeTriangles) {
  TriMesh surface = testing::block_surface(Vec3(4, 4, 4));
  surface.triangles.push_back(surface.triangles.front());
  EXPECT_THAT(message_of(surface), HasSubstr("joins 3 triangles"));
}

TEST(OccupancyOfSurface, RefusesNeighboursThatFaceOppositeWays) {
  TriMesh surface = testing::block_surface(Vec3(4, 4, 4));
  std::swap(surface.triangles[3][0], surface.triangles[3][1]);
  EXPECT_THAT(message_of(surface), HasSubstr("face opposite ways"));
}

TEST(OccupancyOfSurface, RefusesBrokenSurfacesAndVoxels) {
  EXPECT_THAT(message_of({}), HasSubstr("no triangles"));
  TriMesh surface = testing::block_surface(Vec3(4, 4, 4));
  surface.triangles[2][1] = VertexId(std::size_t{99});
  EXPECT_THAT(message_of(surface), HasSubstr("triangle 2 names vertex 99"));
  surface = testing::block_surface(Vec3(4, 4, 4));
  surface.vertices[5].z() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message_of(surface), HasSubstr("vertex 5 is not finite"));
  surface = testing::block_surface(Vec3(4, 4, 4));
  EXPECT_THROW(static_cast<void>(occupancy_of(surface, 0.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(occupancy_of(surface, 1e-4)), InvalidArgument);
}

}  // namespace
}  // namespace incise
