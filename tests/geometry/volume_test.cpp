#include <incise/geometry/volume.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

VolumeGrid tilted_grid() {
  VolumeGrid grid;
  grid.size = {4, 3, 2};
  grid.spacing_mm = {0.5, 1.0, 2.0};
  grid.origin_mm = {10, 20, 30};
  grid.direction = Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()).matrix();
  return grid;
}

TEST(VolumeGrid, RunsThroughIFastest) {
  const VolumeGrid grid = tilted_grid();
  EXPECT_EQ(grid.voxel_count(), 24U);
  EXPECT_EQ(grid.offset(1, 0, 0), 1U);
  EXPECT_EQ(grid.offset(0, 1, 0), 4U);
  EXPECT_EQ(grid.offset(0, 0, 1), 12U);
  EXPECT_TRUE(grid.contains(3, 2, 1));
  EXPECT_FALSE(grid.contains(4, 2, 1));
  EXPECT_FALSE(grid.contains(0, -1, 0));
  EXPECT_DOUBLE_EQ(grid.voxel_volume_mm3(), 1.0);
}

TEST(VolumeGrid, HasItsOriginAtTheCentreOfTheFirstVoxel) {
  VolumeGrid grid = tilted_grid();
  EXPECT_EQ(grid.world_from_index(Vec3::Zero()), grid.origin_mm);
  grid.direction.setIdentity();
  EXPECT_LT((grid.world_from_index({1, 1, 1}) - Vec3(10.5, 21, 32)).norm(), 1e-12);
}

TEST(VolumeGrid, MapsWorldAndIndexBothWays) {
  const VolumeGrid grid = tilted_grid();
  const Vec3 index(1.25, -0.5, 1.75);
  EXPECT_LT((grid.index_from_world(grid.world_from_index(index)) - index).norm(), 1e-12);
}

TEST(Volume, ReadsAndWritesByIndex) {
  LabelVolume labels{tilted_grid(), std::vector<std::uint8_t>(24, 0)};
  labels.at(3, 2, 1) = 7;
  EXPECT_EQ(labels.voxels[23], 7);
}

}  // namespace
}  // namespace incise
