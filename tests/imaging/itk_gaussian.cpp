#include "itk_gaussian.hpp"

#include <itkDiscreteGaussianImageFilter.h>
#include <itkImage.h>

#include <algorithm>

namespace incise::testing {

std::vector<float> itk_gaussian(const std::vector<float>& values, const std::array<int, 3>& size,
                                const std::array<double, 3>& spacing, double sigma) {
  using Image = itk::Image<float, 3>;
  auto image = Image::New();
  Image::SizeType extent;
  for (unsigned axis = 0; axis < 3; ++axis) extent[axis] = static_cast<itk::SizeValueType>(size[axis]);
  image->SetRegions(extent);
  image->SetSpacing(spacing.data());
  image->Allocate();
  std::copy(values.begin(), values.end(), image->GetBufferPointer());
  auto filter = itk::DiscreteGaussianImageFilter<Image, Image>::New();
  filter->SetInput(image);
  filter->SetVariance(sigma * sigma);
  filter->SetUseImageSpacing(true);
  filter->SetMaximumError(1e-3);
  filter->SetMaximumKernelWidth(101);
  filter->Update();
  const float* first = filter->GetOutput()->GetBufferPointer();
  return {first, first + values.size()};
}

}  // namespace incise::testing
