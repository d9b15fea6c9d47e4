#include "imaging/volume_filters.hpp"

#include "itk_gaussian.hpp"

#include <incise/core/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

GrayVolume noise(const std::array<int, 3>& size, const Vec3& spacing_mm) {
  GrayVolume volume{VolumeGrid{size, spacing_mm}, {}};
  Random random(7);
  for (std::size_t v = 0; v < volume.grid.voxel_count(); ++v)
    volume.voxels.push_back(static_cast<float>(random.uniform(0.0, 1.0)));
  return volume;
}

TEST(VolumeFilters, AGaussianHasTheBitsOfItks) {
  Workers workers(2);
  for (const auto& size : {std::array{13, 9, 7}, std::array{1, 1, 5}, std::array{40, 3, 2}, std::array{2, 31, 17}}) {
    for (const double sigma : {0.05, 0.6, 1.2, 2.5}) {
      const GrayVolume volume = noise(size, Vec3(0.8, 1.0, 2.3));
      EXPECT_EQ(gaussian(volume, sigma, workers).voxels,
                testing::itk_gaussian(volume.voxels, size, {0.8, 1.0, 2.3}, sigma))
          << size[0] << " x " << size[1] << " x " << size[2] << ", sigma " << sigma;
    }
  }
}

TEST(VolumeFilters, DistancesAreThoseToTheNearestOfAllVoxels) {
  Random random(11);
  Workers workers(2);
  for (const auto& size : {std::array{9, 7, 5}, std::array{1, 1, 6}, std::array{12, 2, 3}}) {
    Mask mask{VolumeGrid{size, Vec3(0.8, 1.0, 2.3)}, {}};
    for (std::size_t v = 0; v < mask.grid.voxel_count(); ++v) mask.voxels.push_back(random.uniform(0.0, 1.0) < 0.07);
    mask.voxels.back() = 1;
    const GrayVolume found = distance_to(mask, workers);
    for (std::size_t v = 0; v < mask.voxels.size(); ++v) {
      const auto place = [&](std::size_t of) {
        const auto [i, j, k] = mask.grid.voxel_at(of);
        return mask.grid.world_from_index(Vec3(i, j, k));
      };
      double nearest_mm = std::numeric_limits<double>::infinity();
      for (std::size_t w = 0; w < mask.voxels.size(); ++w) {
        if (mask.voxels[w] != 0) nearest_mm = std::min(nearest_mm, (place(v) - place(w)).norm());
      }
      EXPECT_FLOAT_EQ(found.voxels[v], static_cast<float>(nearest_mm)) << size[0] << ", voxel " << v;
    }
  }
}

TEST(VolumeFilters, DistancesToAnEmptyMaskAreInfinite) {
  const Mask none{VolumeGrid{{3, 2, 2}, Vec3::Ones()}, std::vector<std::uint8_t>(12, 0)};
  Workers workers(1);
  for (const float distance : distance_to(none, workers).voxels) EXPECT_TRUE(std::isinf(distance));
}

TEST(VolumeFilters, AGaussianOfWidth0IsTheInput) {
  const GrayVolume volume = noise({5, 4, 3}, Vec3::Ones());
  Workers workers(1);
  EXPECT_EQ(gaussian(volume, 0.0, workers).voxels, volume.voxels);
}

}  // namespace
}  // namespace incise
