#include <incise/core/error.hpp>
#include <incise/geometry/gaussian.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kReachInSigmas = 4.0;

/// Convolves `planes` blocks of `count` rows, each row `width` adjacent values: along x width = 1, along y a row, along
/// z a slice. @param kernel  weights at distance 0, 1, ….
template <class Number>
void blur_rows(std::vector<Number>& values, std::size_t planes, std::size_t count, std::size_t width,
               const std::vector<Number>& kernel) {
  std::vector<Number> source(count * width);
  const auto reach = static_cast<std::ptrdiff_t>(kernel.size()) - 1;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    Number* const block = values.data() + plane * count * width;
    std::copy(block, block + count * width, source.begin());
    for (std::ptrdiff_t row = 0; row < static_cast<std::ptrdiff_t>(count); ++row) {
      Number* const target = block + static_cast<std::size_t>(row) * width;
      std::fill(target, target + width, Number{0});
      const std::ptrdiff_t first = std::max<std::ptrdiff_t>(row - reach, 0);
      const std::ptrdiff_t last = std::min<std::ptrdiff_t>(row + reach, static_cast<std::ptrdiff_t>(count) - 1);
      for (std::ptrdiff_t other = first; other <= last; ++other) {
        const Number weight = kernel[static_cast<std::size_t>(std::abs(other - row))];
        const Number* const from = source.data() + static_cast<std::size_t>(other) * width;
        for (std::size_t i = 0; i < width; ++i) target[i] += weight * from[i];
      }
    }
  }
}

}  // namespace

int gaussian_reach(double sigma) {
  return static_cast<int>(std::ceil(kReachInSigmas * sigma));
}

std::vector<double> gaussian_weights(double sigma) {
  std::vector<double> weights;
  for (int k = 0; k <= gaussian_reach(sigma); ++k) weights.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
  return weights;
}

ScalarRaster blurred(const Raster& raster, double sigma_mm) {
  INCISE_REQUIRE(std::isfinite(sigma_mm) && sigma_mm >= 0.0,
                 fmt::format("expected a sigma of 0 mm or more, found {}", sigma_mm));
  ScalarRaster result(raster, 0.0);
  std::copy(raster.pixels.begin(), raster.pixels.end(), result.pixels.begin());
  if (sigma_mm == 0.0) return result;
  std::vector<double> kernel = gaussian_weights(sigma_mm / raster.pixel_mm);
  double sum = 0.0;
  for (std::size_t k = kernel.size() - 1; k > 0; --k) sum += kernel[k];  // the two halves, added from end to end
  for (const double weight : kernel) sum += weight;
  for (double& weight : kernel) weight /= sum;
  const auto width = static_cast<std::size_t>(raster.width);
  const auto height = static_cast<std::size_t>(raster.height);
  blur_rows(result.pixels, height, width, 1, kernel);
  blur_rows(result.pixels, 1, height, width, kernel);
  return result;
}

void blur(GrayVolume& volume, double sigma_voxels) {
  if (sigma_voxels <= 0.0) return;
  const std::vector<double> weights = gaussian_weights(sigma_voxels);
  double sum = weights.front();
  for (std::size_t k = 1; k < weights.size(); ++k) sum += 2.0 * weights[k];
  std::vector<float> kernel;
  for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
  const auto nx = static_cast<std::size_t>(volume.grid.size[0]);
  const auto ny = static_cast<std::size_t>(volume.grid.size[1]);
  const auto nz = static_cast<std::size_t>(volume.grid.size[2]);
  blur_rows(volume.voxels, ny * nz, nx, 1, kernel);
  blur_rows(volume.voxels, nz, ny, nx, kernel);
  blur_rows(volume.voxels, 1, nz, nx * ny, kernel);
}

}  // namespace incise
