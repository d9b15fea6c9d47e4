#include "imaging/volume_filters.hpp"

#include <incise/core/image_library_turn.hpp>
#include <incise/geometry/distance_line.hpp>

#include <itkConnectedComponentImageFilter.h>
#include <itkGaussianOperator.h>
#include <itkImage.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::size_t kLinesPerChunk = 64;

template <class Value>
using Image = itk::Image<Value, 3>;

// Copies size and spacing only: orientation does not matter to these filters.
template <class Value>
typename Image<Value>::Pointer image_from(const Volume<Value>& volume) {
  auto image = Image<Value>::New();
  typename Image<Value>::SizeType size;
  typename Image<Value>::SpacingType spacing;
  for (unsigned axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<itk::SizeValueType>(volume.grid.size[axis]);
    spacing[axis] = volume.grid.spacing_mm[axis];
  }
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  std::copy(volume.voxels.begin(), volume.voxels.end(), image->GetBufferPointer());
  return image;
}

template <class Value>
Volume<Value> volume_from(const Image<Value>& image, const VolumeGrid& grid) {
  const Value* first = image.GetBufferPointer();
  return {grid, std::vector<Value>(first, first + grid.voxel_count())};
}

// Renumbers pieces by their first voxel in storage order, independent of the filter's order, and returns their number.
std::int32_t renumber(std::vector<std::int32_t>& numbers) {
  const std::int32_t largest = *std::max_element(numbers.begin(), numbers.end());
  std::vector<std::int32_t> renamed(static_cast<std::size_t>(largest) + 1, 0);
  std::int32_t count = 0;
  for (std::int32_t& number : numbers) {
    if (number == 0) continue;
    std::int32_t& name = renamed[static_cast<std::size_t>(number)];
    if (name == 0) name = ++count;
    number = name;
  }
  return count;
}

/// Returns the weights of Lindeberg's discrete Gaussian (1990), from one end to the other, by ITK's operator.
std::vector<double> gaussian_kernel(double variance_voxels) {
  itk::GaussianOperator<double, 3> kernel;
  kernel.SetDirection(0);
  kernel.SetVariance(variance_voxels);
  kernel.SetMaximumError(1e-3);
  kernel.SetMaximumKernelWidth(101);
  kernel.CreateDirectional();
  return {kernel.Begin(), kernel.End()};
}

/// Sums the lines `line(k)`, weighted, in the order of the weights. Takes four at a time to keep the sums in registers;
/// the bits are the same as one at a time.
template <class Line>
void sum_up(const std::vector<double>& kernel, const Line& line, std::vector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  std::size_t k = 0;
  for (; k + 4 <= kernel.size(); k += 4) {
    const double *a = line(k), *b = line(k + 1), *c = line(k + 2), *d = line(k + 3);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      double sum = sums[i] + kernel[k] * a[i];
      sum += kernel[k + 1] * b[i];
      sum += kernel[k + 2] * c[i];
      sums[i] = sum + kernel[k + 3] * d[i];
    }
  }
  for (; k < kernel.size(); ++k) {
    const double* const a = line(k);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += kernel[k] * a[i];
  }
}

/// Convolves `wide` adjacent lines along one axis, on which neighbouring voxels are `stride` apart. Values repeat
/// beyond the border. Sums run from one end of the kernel to the other in double, as in ITK's filter.
void convolve(float* first, std::size_t wide, std::size_t count, std::size_t stride,
              const std::vector<double>& kernel) {
  const auto reach = static_cast<std::ptrdiff_t>(kernel.size() / 2), last = static_cast<std::ptrdiff_t>(count) - 1;
  std::vector<double> source(count * wide), sums(wide);
  for (std::size_t at = 0; at < count; ++at)
    std::copy_n(first + at * stride, wide, source.begin() + static_cast<std::ptrdiff_t>(at * wide));
  for (std::ptrdiff_t at = 0; at <= last; ++at) {
    const auto line = [&](std::size_t k) {
      const std::ptrdiff_t other = std::clamp(at + static_cast<std::ptrdiff_t>(k) - reach, std::ptrdiff_t{0}, last);
      return source.data() + static_cast<std::size_t>(other) * wide;
    };
    sum_up(kernel, line, sums);
    float* const target = first + static_cast<std::size_t>(at) * stride;
    for (std::size_t i = 0; i < wide; ++i) target[i] = static_cast<float>(sums[i]);
  }
}

/// Convolves rows along x, where neighbours are adjacent in memory: sums copies of the padded row, shifted and
/// weighted.
void convolve_rows(float* first, std::size_t rows, std::size_t count, const std::vector<double>& kernel) {
  const std::size_t reach = kernel.size() / 2;
  std::vector<double> padded(count + 2 * reach), sums(count);
  for (std::size_t row = 0; row < rows; ++row) {
    float* const line = first + row * count;
    std::copy(line, line + count, padded.begin() + static_cast<std::ptrdiff_t>(reach));
    std::fill_n(padded.begin(), reach, line[0]);
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(reach), reach, line[count - 1]);
    sum_up(
        kernel, [&](std::size_t k) { return padded.data() + k; }, sums);
    for (std::size_t i = 0; i < count; ++i) line[i] = static_cast<float>(sums[i]);
  }
}

}  // namespace

Pieces find_pieces(const Mask& mask) {
  const ImageLibraryTurn turn;
  auto filter = itk::ConnectedComponentImageFilter<Image<std::uint8_t>, Image<std::int32_t>>::New();
  filter->SetInput(image_from(mask));
  filter->SetFullyConnected(false);
  filter->Update();
  Pieces pieces{volume_from(*filter->GetOutput(), mask.grid), 0};
  pieces.count = renumber(pieces.number.voxels);
  return pieces;
}

GrayVolume distance_to(const Mask& mask, Workers& workers) {
  const VolumeGrid& grid = mask.grid;
  std::vector<double> squared(mask.voxels.size(), std::numeric_limits<double>::infinity());
  for (std::size_t v = 0; v < squared.size(); ++v) {
    if (mask.voxels[v] != 0) squared[v] = 0.0;
  }
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<std::size_t>(grid.size[static_cast<std::size_t>(axis)]);
    const std::size_t lines = count > 0 ? squared.size() / count : 0;
    workers.for_chunks(lines, kLinesPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      DistanceLine line;
      line.values.resize(count);
      for (std::size_t number = begin; number < end; ++number) {
        const std::size_t start = number / stride * stride * count + number % stride;
        for (std::size_t i = 0; i < count; ++i) line.values[i] = squared[start + i * stride];
        line.transform(grid.spacing_mm[axis]);
        for (std::size_t i = 0; i < count; ++i) squared[start + i * stride] = line.result[i];
      }
    });
    stride *= count;
  }
  GrayVolume distance{grid, std::vector<float>(squared.size())};
  std::ranges::transform(squared, distance.voxels.begin(), [](double d) { return static_cast<float>(std::sqrt(d)); });
  return distance;
}

GrayVolume gaussian(GrayVolume volume, double sigma, Workers& workers) {
  if (sigma == 0.0 || volume.voxels.empty()) return volume;
  const auto kernel = [&](int axis) {
    const double spacing = volume.grid.spacing_mm[axis];
    return gaussian_kernel(sigma * sigma / (spacing * spacing));
  };
  const auto nx = static_cast<std::size_t>(volume.grid.size[0]);
  const auto ny = static_cast<std::size_t>(volume.grid.size[1]);
  const auto nz = static_cast<std::size_t>(volume.grid.size[2]);
  float* const voxels = volume.voxels.data();
  const std::vector<double> along_x = kernel(0), along_y = kernel(1), along_z = kernel(2);
  workers.for_each(ny, 1, [&](std::size_t j) { convolve(voxels + j * nx, nx, nz, nx * ny, along_z); });
  workers.for_each(nz, 1, [&](std::size_t k) {
    convolve(voxels + k * nx * ny, nx, ny, nx, along_y);
    convolve_rows(voxels + k * nx * ny, ny, nx, along_x);
  });
  return volume;
}

Mask complement(const Mask& mask) {
  return mask_where(mask, [](std::uint8_t value) { return value == 0; });
}

}  // namespace incise
