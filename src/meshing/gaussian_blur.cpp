#include "meshing/gaussian_blur.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace incise::meshing_detail {
namespace {

constexpr double kReachInSigmas = 4.0;

/// Weights at distance 0, 1, … reach; the two-sided sum is 1.
std::vector<float> half_kernel(double sigma_voxels) {
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = 0; k <= blur_reach(sigma_voxels); ++k) {
    weights.push_back(std::exp(-0.5 * k * k / (sigma_voxels * sigma_voxels)));
    sum += (k == 0 ? 1.0 : 2.0) * weights.back();
  }
  std::vector<float> normalised;
  for (const double w : weights) normalised.push_back(static_cast<float>(w / sum));
  return normalised;
}

/// Convolves `planes` blocks of `count` rows, each row `width` adjacent values: along x width = 1, along y a row, along
/// z a slice.
void blur_rows(std::vector<float>& values, std::size_t planes, std::size_t count, std::size_t width,
               const std::vector<float>& kernel) {
  std::vector<float> source(count * width);
  const auto reach = static_cast<std::ptrdiff_t>(kernel.size()) - 1;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    float* const block = values.data() + plane * count * width;
    std::copy(block, block + count * width, source.begin());
    for (std::ptrdiff_t row = 0; row < static_cast<std::ptrdiff_t>(count); ++row) {
      float* const target = block + static_cast<std::size_t>(row) * width;
      std::fill(target, target + width, 0.0F);
      const std::ptrdiff_t first = std::max<std::ptrdiff_t>(row - reach, 0);
      const std::ptrdiff_t last = std::min<std::ptrdiff_t>(row + reach, static_cast<std::ptrdiff_t>(count) - 1);
      for (std::ptrdiff_t other = first; other <= last; ++other) {
        const float weight = kernel[static_cast<std::size_t>(std::abs(other - row))];
        const float* const from = source.data() + static_cast<std::size_t>(other) * width;
        for (std::size_t i = 0; i < width; ++i) target[i] += weight * from[i];
      }
    }
  }
}

}  // namespace

int blur_reach(double sigma_voxels) {
  return static_cast<int>(std::ceil(kReachInSigmas * sigma_voxels));
}

void blur(GrayVolume& volume, double sigma_voxels) {
  if (sigma_voxels <= 0.0) return;
  const std::vector<float> kernel = half_kernel(sigma_voxels);
  const auto [nx, ny, nz] =
      std::array{static_cast<std::size_t>(volume.grid.size[0]), static_cast<std::size_t>(volume.grid.size[1]),
                 static_cast<std::size_t>(volume.grid.size[2])};
  blur_rows(volume.voxels, ny * nz, nx, 1, kernel);
  blur_rows(volume.voxels, nz, ny, nx, kernel);
  blur_rows(volume.voxels, 1, nz, nx * ny, kernel);
}

}  // namespace incise::meshing_detail
