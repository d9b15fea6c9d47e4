#pragma once

#include <array>
#include <vector>

namespace incise::testing {

/// What ITK's DiscreteGaussianImageFilter makes of a volume, x fastest. @param sigma  in the unit of the spacing.
std::vector<float> itk_gaussian(const std::vector<float>& values, const std::array<int, 3>& size,
                                const std::array<double, 3>& spacing, double sigma);

}  // namespace incise::testing
