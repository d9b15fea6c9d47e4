#include "imaging/volume_filters.hpp"

#include <incise/core/image_library_turn.hpp>

#include <itkConnectedComponentImageFilter.h>
#include <itkDiscreteGaussianImageFilter.h>
#include <itkImage.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

template <class Value>
using Image = itk::Image<Value, 3>;

// Orientation does not matter to these filters, so only size and spacing go along.
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

// Numbers pieces by their first voxel in storage order, whatever order the filter used.
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

GrayVolume distance_to(const Mask& mask) {
  if (std::find(mask.voxels.begin(), mask.voxels.end(), std::uint8_t{1}) == mask.voxels.end())
    return {mask.grid, std::vector<float>(mask.voxels.size(), std::numeric_limits<float>::infinity())};
  const ImageLibraryTurn turn;
  auto filter = itk::SignedMaurerDistanceMapImageFilter<Image<std::uint8_t>, Image<float>>::New();
  filter->SetInput(image_from(mask));
  filter->SetSquaredDistance(false);
  filter->SetUseImageSpacing(true);
  filter->SetInsideIsPositive(false);
  filter->Update();
  GrayVolume distance = volume_from(*filter->GetOutput(), mask.grid);
  for (std::size_t v = 0; v < distance.voxels.size(); ++v)
    distance.voxels[v] = mask.voxels[v] != 0 ? 0.0F : std::max(0.0F, distance.voxels[v]);
  return distance;
}

GrayVolume gaussian(GrayVolume volume, double sigma) {
  if (sigma == 0.0) return volume;
  const ImageLibraryTurn turn;
  auto filter = itk::DiscreteGaussianImageFilter<Image<float>, Image<float>>::New();
  filter->SetInput(image_from(volume));
  filter->SetVariance(sigma * sigma);
  filter->SetUseImageSpacing(true);
  filter->SetMaximumError(1e-3);
  filter->SetMaximumKernelWidth(101);
  filter->Update();
  return volume_from(*filter->GetOutput(), volume.grid);
}

Mask complement(const Mask& mask) {
  Mask other{mask.grid, std::vector<std::uint8_t>(mask.voxels.size())};
  std::transform(mask.voxels.begin(), mask.voxels.end(), other.voxels.begin(),
                 [](std::uint8_t value) { return static_cast<std::uint8_t>(value == 0); });
  return other;
}

}  // namespace incise
