#include <incise/core/error.hpp>
#include <incise/geometry/iso_surface.hpp>
#include <incise/geometry/manifoldness.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace incise {
namespace {

/// Falls from the middle outwards by 1 per mm, 0 at the radius.
GrayVolume ball(double radius_mm, const VolumeGrid& grid) {
  GrayVolume volume{grid, std::vector<float>(grid.voxel_count())};
  for (std::size_t at = 0; at < volume.voxels.size(); ++at) {
    const auto [i, j, k] = grid.voxel_at(at);
    volume.voxels[at] = static_cast<float>(radius_mm - grid.world_from_index(Vec3(i, j, k)).norm());
  }
  return volume;
}

VolumeGrid grid_of(int size, double spacing_mm) {
  VolumeGrid grid{{size, size, size}};
  grid.spacing_mm = Vec3::Constant(spacing_mm);
  grid.origin_mm = Vec3::Constant(-0.5 * (size - 1) * spacing_mm);
  return grid;
}

TEST(IsoSurface, IsABallOutwardsWithItsVolume) {
  for (const double spacing_mm : {1.0, 0.5}) {
    const TriMesh surface = iso_surface(ball(8.0, grid_of(static_cast<int>(20 / spacing_mm), spacing_mm)), 0.0);
    const double exact = 4.0 / 3.0 * std::numbers::pi * 512.0;
    EXPECT_NEAR(enclosed_volume_mm3(surface), exact, 0.02 * spacing_mm * spacing_mm * exact) << spacing_mm;
    for (const Vec3& v : surface.vertices) EXPECT_NEAR(v.norm(), 8.0, 0.15 * spacing_mm);
  }
}

TEST(IsoSurface, IsClosedWhereTheVolumeCutsTheBody) {
  const TriMesh surface = iso_surface(ball(8.0, grid_of(10, 1.0)), 0.0);  // a cube of 9 mm cut out of the ball
  const Manifoldness found = manifoldness_of(surface.triangles);
  EXPECT_EQ(found.open_edges, 0U);
  EXPECT_GT(enclosed_volume_mm3(surface), 0.0);
}

TEST(IsoSurface, IsOutwardsInAMirroredGrid) {
  VolumeGrid grid = grid_of(20, 1.0);
  grid.direction.col(0) *= -1.0;
  grid.origin_mm.x() *= -1.0;
  EXPECT_GT(enclosed_volume_mm3(iso_surface(ball(8.0, grid), 0.0)), 0.0);
}

TEST(IsoSurface, IsEmptyWhereNothingReachesTheLevel) {
  EXPECT_TRUE(iso_surface(ball(8.0, grid_of(20, 1.0)), 9.0).triangles.empty());
}

TEST(IsoSurface, RefusesWhatIsNotFinite) {
  GrayVolume volume = ball(2.0, grid_of(5, 1.0));
  EXPECT_THROW(static_cast<void>(iso_surface(volume, std::numeric_limits<double>::quiet_NaN())), InvalidArgument);
  volume.voxels[3] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(static_cast<void>(iso_surface(volume, 0.0)), InvalidArgument);
}

}  // namespace
}  // namespace incise
