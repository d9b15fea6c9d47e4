#include "imaging/volume_filters.hpp"

#include "itk_gaussian.hpp"

#include <incise/core/random.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

GrayVolume noise(const std::array<int, 3>& size, const Vec3& spacing_mm) {
  GrayVolume volume{VolumeGrid{size, spacing_mm}, {}};
  Random random(7);
  for (std::size_t v = 0; v < volume.grid.voxel_count(); ++v) volume.voxels.push_back(static_cast<float>(random.uniform(0.0, 1.0)));
  return volume;
}

TEST(VolumeFilters, AGaussianHasTheBitsOfItks) {
  for (const auto& size : {std::array{13, 9, 7}, std::array{1, 1, 5}, std::array{40, 3, 2}, std::array{2, 31, 17}}) {
    for (const double sigma : {0.05, 0.6, 1.2, 2.5}) {
      const GrayVolume volume = noise(size, Vec3(0.8, 1.0, 2.3));
      EXPECT_EQ(gaussian(volume, sigma).voxels, testing::itk_gaussian(volume.voxels, size, {0.8, 1.0, 2.3}, sigma))
          << size[0] << " x " << size[1] << " x " << size[2] << ", sigma " << sigma;
    }
  }
}

TEST(VolumeFilters, AGaussianOfWidth0IsTheInput) {
  const GrayVolume volume = noise({5, 4, 3}, Vec3::Ones());
  EXPECT_EQ(gaussian(volume, 0.0).voxels, volume.voxels);
}

}  // namespace
}  // namespace incise
