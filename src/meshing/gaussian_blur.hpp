#pragma once

#include <incise/geometry/volume.hpp>

namespace incise::meshing_detail {

/// Convolves with a Gaussian sampled at whole voxels out to 4 sigma, its weights summing to 1; outside the grid is 0.
void blur(GrayVolume& volume, double sigma_voxels);

/// Voxels of margin that hold all that `blur` moves outwards.
[[nodiscard]] int blur_reach(double sigma_voxels);

}  // namespace incise::meshing_detail
